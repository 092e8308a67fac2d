// Show a comparison of estimators: errors and cost of each, then the parameters side by side.
import { follow } from "../base/api.js";
import { element, fill } from "../base/dom.js";
import { warnings } from "./headline.js";
import { scrolling } from "../drawing/wide.js";
import { measured, number, plural, relative } from "../base/words.js";

// Standard deviations, the larger of the two, from which two estimates are marked as different.
const CLEAR = 3;

/** Show which estimator predicts held-out torque best, and how far they lie apart. */
export function showComparison(container, { document }) {
  const given = document.compared.filter((row) => row.validation_total_percent !== null);
  const best = given.reduce((one, other) => (one && one.validation_total_percent <= other.validation_total_percent ? one : other), null);
  const failed = document.compared.filter((row) => row.failure);
  fill(container, element("section", { class: "card headline", "aria-label": "Summary" },
    warnings(document),
    element("p", { class: "verdict" }, `${plural("estimator", document.compared.length)} on the same ${document.logs.length > 1 ? "logs" : "log"}`),
    element("div", { class: "figures" },
      best ? figure(relative(best.validation_total_percent), `smallest torque error on held-out data, by ${best.estimator}`) : null,
      figure(`${document.compared.length - failed.length} of ${document.compared.length}`, "gave an estimate"),
      figure(String(document.parameters.length), "base parameters"))));
}

export const COMPARED = [
  ["estimators", "Estimators", showEstimators],
  ["parameters", "Base parameters", showParameters],
  ["export", "Export", showFiles],
];

function figure(big, small) {
  return element("div", {}, element("strong", {}, big), element("span", {}, small));
}

function showEstimators(container, { document }) {
  const rows = document.compared.map((row) => [
    `${row.title} (${row.estimator})`,
    relative(row.validation_total_percent),
    relative(motion(row.simulated_motion)),
    row.feasible === null ? "–" : row.feasible ? "yes" : "no",
    row.estimation ? String(row.estimation.steps.length || 1) : "–",
    number(row.cpu_seconds, 2),
  ]);
  fill(container,
    table("Errors on held-out data, consistency and cost", ["Estimator", "Torque error, % of RMS", "Motion error, %", "Consistent", "Steps", "CPU, s"], rows),
    element("p", { class: "hint" }, "Motion error: of simulated positions at the longest horizon, as a share of the error of a robot that keeps its velocity."),
    remarks(document.compared));
}

function motion(found) {
  if (!found) return null;
  const last = found.position_rms.length - 1;
  const shares = found.position_rms[last].map((error, joint) => error / found.steady_rms[last][joint]).filter(Number.isFinite);
  return shares.length ? 100 * Math.sqrt(shares.reduce((sum, share) => sum + share ** 2, 0) / shares.length) : null;
}

// Why an estimator failed or could not be simulated, how it ended, and what its instruments tell; what is said
// of several once.
function remarks(compared) {
  const said = new Map();
  for (const row of compared) {
    for (const text of remarksOf(row)) said.set(text, [...(said.get(text) ?? []), row.estimator]);
  }
  return said.size ? element("ul", {}, [...said].map(([text, names]) => element("li", {}, `${names.join(", ")}: ${text}`))) : null;
}

function remarksOf(row) {
  return [
    row.failure ? `${row.failure.cause}; ${row.failure.remedy}.` : null,
    row.simulated_motion_note ? `motion was not simulated: ${row.simulated_motion_note}.` : null,
    ...(row.estimation?.statements.slice(1) ?? []), // the first sentence names the estimator
  ].filter(Boolean);
}

function showParameters(container, { document }) {
  const given = document.compared.filter((row) => row.base_parameters.length);
  const rows = document.parameters.map((parameter, place) => [
    element("span", { title: parameter.grouping }, parameter.name),
    parameter.unit,
    ...given.map((row) => value(row.base_parameters[place], given[0].base_parameters[place])),
  ]);
  fill(container,
    table("Value ± standard deviation by every estimator", ["Parameter", "Unit", ...given.map((row) => row.estimator)], rows),
    given.length ? element("p", { class: "hint" }, `Bold: more than ${CLEAR} standard deviations from ${given[0].estimator}.`) : null);
}

function value(own, first) {
  const deviation = own.standard_deviation;
  const text = measured(own.value, deviation);
  const apart = Math.abs(own.value - first.value) > CLEAR * Math.max(deviation ?? Infinity, first.standard_deviation ?? Infinity);
  return apart ? element("strong", {}, text) : text;
}

function showFiles(container, { job }) {
  const files = [
    ["results", "results.json", "Result document (JSON) with every number of this page"],
    ["results/comparison.csv", "comparison.csv", "Parameters by every estimator"],
    ["results/comparison.tex", "comparison.tex", "The same as a LaTeX table"],
  ];
  fill(container, element("ul", { class: "files" }, files.map(([path, name, title]) => {
    const link = element("a", { href: `${job.links.self}/${path}`, download: name }, name);
    return element("li", {}, follow(link), element("span", {}, title));
  })));
}

function table(caption, headings, rows) {
  return scrolling(element("div", { class: "wide" }, element("table", { class: "checked" },
    element("caption", {}, caption),
    element("thead", {}, element("tr", {}, headings.map((heading) => element("th", { scope: "col" }, heading)))),
    element("tbody", {}, rows.map(([head, ...cells]) => element("tr", {}, element("th", { scope: "row" }, head), cells.map((cell) => element("td", {}, cell))))))), caption);
}
