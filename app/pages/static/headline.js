// Say in words what came out, with the few numbers that everybody asks for.
import { follow } from "./api.js";
import { element, fill } from "./dom.js";
import { number, plural } from "./words.js";

/** Show the verdict and the key figures. */
export function showHeadline(container, { job, document, report }) {
  const verdict = report.querySelector(".verdict")?.textContent.replaceAll(" %", "\u00a0%") ?? "";
  const glance = [...report.querySelectorAll("main > header > ol, main > header > p:not(.verdict)")].map(copied);
  fill(container, element("section", { class: "card headline", "aria-label": "What came out" },
    element("p", { class: "verdict" }, verdict),
    glance,
    element("div", { class: "figures" }, figures(document)),
    element("p", {}, follow(element("a", { class: "button", href: job.links.report, download: null }, "Open the report"))),
    doubts(document)));
}

/** A percentage as people read it. */
export function relative(value, digits = 3) {
  return value === null || value === undefined ? "–" : `${number(value, digits)}\u00a0%`;
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
    figure(cured === null ? relative(held ?? document.fit_total_percent) : `${number(held, 3)} → ${relative(cured)}`,
      `torque error on ${held === null || held === undefined ? "the fitted motion" : "held-out motion"}, RMS of residual over RMS of torque${cured === null ? "" : ", before and after the cure"}; ${cured === null ? "" : "before: "}from ${relative(byError[0]?.nrmse_of_rms_percent)} (joint ${byError[0]?.joint}) to ${relative(byError.at(-1)?.nrmse_of_rms_percent)} (joint ${byError.at(-1)?.joint})`),
    figure(counts.essential === null ? counts.base : `${counts.essential} of ${counts.base}`,
      `base parameters are essential, grouped from ${plural("standard parameter", counts.standard)}`),
    best ? figure(relative(best.relative_deviation_percent), `%P of the best known essential parameter, ${best.name}; the least known, ${worst.name}, has ${relative(worst.relative_deviation_percent)}`) : null,
    figure(feasibility.feasible ? "Can exist" : "Cannot exist",
      `the identified robot; plain least squares gives one that ${feasibility.ols_feasible ? "can" : "cannot"}`, feasibility.feasible ? "good" : "bad"),
  ];
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
