// Show the headline of a result and its key figures.
import { follow } from "../base/api.js";
import { element, fill } from "../base/dom.js";
import { consistency, plural, relative } from "../base/words.js";

/** Show the verdict and the key figures. */
export function showHeadline(container, { job, document, report }) {
  const verdict = report.querySelector(".verdict")?.textContent.replaceAll(" %", "\u00a0%") ?? "";
  const glance = [...report.querySelectorAll("main > header > ol, main > header > p:not(.verdict):not(.kind)")].map(copied);
  fill(container, element("section", { class: "card headline", "aria-label": "Summary" },
    warnings(document),
    element("p", { class: "verdict" }, verdict),
    glance,
    element("div", { class: "figures" }, figures(document)),
    element("p", {}, follow(element("a", { class: "button", href: job.links.report, download: null }, "Open the report")))));
}

function figures(document) {
  const { counts, feasibility, base_parameters: base } = document;
  const plain = document.diagnosis?.before ?? document;
  const held = plain.validation_total_percent;
  const named = base.filter((row) => row.relative_deviation_percent !== null && row.essential !== false);
  const ranked = [...named].sort((a, b) => a.relative_deviation_percent - b.relative_deviation_percent);
  const [best, worst] = [ranked[0], ranked.at(-1)];
  const errors = plain.validation.length ? plain.validation : plain.fit;
  const byError = errors.filter((row) => row.nrmse_of_rms_percent !== null).sort((a, b) => a.nrmse_of_rms_percent - b.nrmse_of_rms_percent);
  const corrected = document.diagnosis?.after?.validation_total_percent ?? null;
  return [
    figure(corrected === null ? relative(held ?? plain.fit_total_percent) : `${relative(held)} → ${relative(corrected)}`,
      `torque error on ${held === null || held === undefined ? "the fitted data" : "held-out data"}, RMS of residual over RMS of torque${corrected === null ? "" : ", before and after the correction"}${range(byError, corrected === null ? "" : "before: ")}`),
    figure(counts.essential === null ? counts.base : `${counts.essential} of ${counts.base}`,
      `base parameters are essential; they group ${plural("standard parameter", counts.standard)}`),
    best ? figure(relative(best.relative_deviation_percent), `%P of ${best.name}, the best determined essential parameter; the worst, ${worst.name}, has ${relative(worst.relative_deviation_percent)}`) : null,
    figure(feasibility.feasible ? "Physically consistent" : "Physically inconsistent",
      `the identified parameters; those of ordinary least squares are ${consistency(feasibility.ols_feasible)}`,
      feasibility.feasible ? (byError.every((row) => row.quality === "good") ? "good" : null) : "bad"),
  ];
}

// Give the range from the best to the worst predicted joint; empty for one joint.
function range(byError, when) {
  if (byError.length < 2) return "";
  const [best, worst] = [byError[0], byError.at(-1)].map((row) => `${relative(row.nrmse_of_rms_percent)} (joint ${row.joint})`);
  return `; ${when}from ${best} to ${worst}`;
}

function figure(big, small, kind = null) {
  return element("div", {}, element("strong", { class: kind }, big), element("span", {}, small));
}

/** Show the warnings. Those of conflicts come first among them, and have a card of their own. */
export function warnings(document) {
  const doubts = (document.doubts ?? []).slice(document.conflicts?.length ?? 0);
  if (!doubts.length) return null;
  return element("div", { class: "notice" }, element("strong", {}, "Warnings"),
    element("ul", {}, doubts.map((one) => element("li", {}, `${one}.`))));
}

/** Take a part of the report over into this page. */
export function copied(node) {
  return document.importNode(node, true);
}
