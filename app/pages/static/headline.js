// Say in words what came out, with the few numbers that everybody asks for.
import { follow } from "./api.js";
import { element, fill } from "./dom.js";
import { plural, relative } from "./words.js";

/** Show the verdict and the key figures. */
export function showHeadline(container, { job, document, report }) {
  const verdict = report.querySelector(".verdict")?.textContent.replaceAll(" %", "\u00a0%") ?? "";
  const glance = [...report.querySelectorAll("main > header > ol, main > header > p:not(.verdict):not(.kind)")].map(copied);
  fill(container, element("section", { class: "card headline", "aria-label": "What came out" },
    element("p", { class: "verdict" }, verdict),
    glance,
    element("div", { class: "figures" }, figures(document)),
    element("p", {}, follow(element("a", { class: "button", href: job.links.report, download: null }, "Open the report"))),
    doubts(document)));
}

function figures(document) {
  const { counts, feasibility, base_parameters: base } = document;
  const held = document.validation_total_percent;
  const named = base.filter((row) => row.relative_deviation_percent !== null && row.essential !== false);
  const ranked = [...named].sort((a, b) => a.relative_deviation_percent - b.relative_deviation_percent);
  const [best, worst] = [ranked[0], ranked.at(-1)];
  const errors = document.validation.length ? document.validation : document.fit;
  const byError = [...errors].sort((a, b) => a.nrmse_of_rms_percent - b.nrmse_of_rms_percent);
  const cured = document.diagnosis?.after?.validation_total_percent ?? null;
  return [
    figure(cured === null ? relative(held ?? document.fit_total_percent) : `${relative(held)} → ${relative(cured)}`,
      `torque error on ${held === null || held === undefined ? "the fitted motion" : "held-out motion"}, RMS of residual over RMS of torque${cured === null ? "" : ", before and after the cure"}${reach(byError, cured === null ? "" : "before: ")}`),
    figure(counts.essential === null ? counts.base : `${counts.essential} of ${counts.base}`,
      `base parameters are essential, grouped from ${plural("standard parameter", counts.standard)}`),
    best ? figure(relative(best.relative_deviation_percent), `%P of the best known essential parameter, ${best.name}; the least known, ${worst.name}, has ${relative(worst.relative_deviation_percent)}`) : null,
    figure(feasibility.feasible ? "Can exist" : "Cannot exist",
      `the identified robot; plain least squares gives one that ${feasibility.ols_feasible ? "can" : "cannot"}`, feasibility.feasible ? "good" : "bad"),
  ];
}

// From the joint that is predicted best to the worst; of one joint the total tells it all.
function reach(byError, when) {
  if (byError.length < 2) return "";
  const [best, worst] = [byError[0], byError.at(-1)].map((row) => `${relative(row.nrmse_of_rms_percent)} (joint ${row.joint})`);
  return `; ${when}from ${best} to ${worst}`;
}

function figure(big, small, kind = null) {
  return element("div", {}, element("strong", { class: kind }, big), element("span", {}, small));
}

function doubts(document) {
  if (!document.doubts?.length) return null;
  return element("div", { class: "notice" }, element("strong", {}, "What deserves a second look"),
    element("ul", {}, document.doubts.map((one) => element("li", {}, `${one}.`))));
}

/** Take a part of the report over into this page. */
export function copied(node) {
  return document.importNode(node, true);
}
