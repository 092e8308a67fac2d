// The differences of two results, the largest first.
import { element, fill, svg } from "../base/dom.js";
import { draw } from "../drawing/plot.js";
import { showError } from "../base/problem.js";
import { tracesOf } from "./traces.js";
import { wide } from "../drawing/wide.js";
import { measured, number, plain, plural, relative } from "../base/words.js";

const REAL = 3;
const WIDEST = 10;

/** Show how two studies differ: `studies` holds the left and the right one. */
export function showDifferences(container, studies) {
  const rows = parameters(studies);
  fill(container,
    summary(studies, rows),
    part("Settings", setting(studies)),
    part("Error of the predicted torque", errors(studies)),
    studies.some((one) => one.document.diagnosis) ? part("Findings", findings(studies)) : null,
    part("Parameters", table(studies, rows)),
    part("Estimated torque", overlay(studies)));
}

function part(title, ...content) {
  const id = title.toLowerCase().replaceAll(" ", "-");
  return element("section", { class: "card part", "aria-labelledby": id }, element("h2", { id }, title), content);
}

function summary(studies, rows) {
  const real = rows.filter((row) => Math.abs(row.z) > REAL);
  const totals = studies.map((one) => one.document.validation_total_percent ?? one.document.fit_total_percent);
  const worst = real[0];
  return element("section", { class: "card headline compared", "aria-label": "Differences" },
    element("p", { class: "verdict" }, rows.length
      ? `${real.length ? plural("parameter", real.length) : "No parameter"} of ${rows.length} ${real.length < 2 ? "differs" : "differ"} by more than ${REAL} standard deviations${worst ? `, ${worst.name} the most` : ""}.`
      : "The two models have no parameter in common."),
    element("p", {}, `The torque error on ${held(studies)} is ${relative(totals[0])} on the left and ${relative(totals[1])} on the right.`),
    studies.some((one) => one.document.diagnosis) ? element("p", { class: "hint" }, "For a diagnosis, errors and parameters are those of the extended model, the one that its files hold.") : null,
    sharedLogs(studies).length ? element("p", { class: "hint" }, "Both studies used the same log. Their errors are not independent, so the standard deviation of the difference is overestimated.") : null);
}

function held(studies) {
  return studies.every((one) => one.document.validation.length) ? "held-out data" : "the fitted data";
}

// The parameters that both have, by how sure it is that they differ. z: the difference over the root of both variances.
function parameters(studies) {
  const [left, right] = studies.map((one) => new Map(one.document.base_parameters.map((row) => [row.name, row])));
  return [...left.values()].filter((row) => right.has(row.name) && row.unit === right.get(row.name).unit).map((row) => {
    const other = right.get(row.name);
    const deviation = Math.hypot(row.standard_deviation, other.standard_deviation);
    const difference = other.value - row.value;
    return { name: row.name, unit: row.unit, joint: row.joint, left: row, right: other, difference, z: deviation > 0 ? difference / deviation : 0 };
  }).sort((a, b) => Math.abs(b.z) - Math.abs(a.z));
}

function setting(studies) {
  const logs = (one) => one.document.logs.map((log) => log.name).join(", ");
  const bands = (one) => [...new Set(one.document.logs.map((log) => `${number(log.filter?.cutoff_hz, 3)} Hz`))].join(", ");
  const rows = [
    ["Robot", ...studies.map((one) => one.document.robot.name ?? one.robot)],
    ["Logs", ...studies.map(logs)],
    ["Kind", ...studies.map((one) => one.document.kind)],
    ["Model", ...studies.map((one) => one.document.model?.name ?? "plain")],
    ["Options", ...studies.map((one) => options(one.document.provenance.options))],
    ["Filter cut-off", ...studies.map(bands)],
    ["Base parameters", ...studies.map((one) => `${one.document.counts.base}, ${one.document.counts.essential ?? "–"} essential`)],
    ["Physically consistent", ...studies.map((one) => (one.document.feasibility.feasible ? "yes" : "no"))],
    ["Condition number", ...studies.map((one) => number(one.document.condition_number, 3))],
    ["Version", ...studies.map((one) => one.document.provenance.version)],
  ];
  return wide(element("table", { class: "sides" }, heads("", []),
    element("tbody", {}, rows.map(([name, left, right]) => element("tr", { class: left === right ? null : "differs" },
      element("th", { scope: "row" }, name), element("td", {}, left), element("td", {}, right),
      element("td", { class: "soft" }, left === right ? "same" : "differs"))))), "Settings");
}

function heads(first, others) {
  return element("thead", {}, element("tr", {},
    [first, side("Left", 1), side("Right", 2), ...others].map((name) => element("th", { scope: "col" }, name)),
    others.length ? null : element("th", { scope: "col" }, element("span", { class: "visually-hidden" }, "Comparison"))));
}

function side(name, colour) {
  return [element("i", { class: `swatch trace-${colour}`, "aria-hidden": "true" }), name];
}

function options(given) {
  const shown = Object.entries(given ?? {}).map(([name, value]) => `${plain(name)}: ${typeof value === "object" ? JSON.stringify(value) : value}`);
  return shown.join("; ") || "defaults";
}

function errors(studies) {
  const scores = studies.map((one) => (one.document.validation.length ? one.document.validation : one.document.fit));
  const most = Math.max(...scores.flat().map((row) => row.nrmse_of_rms_percent ?? 0), 1e-9);
  const joints = Math.max(...scores.map((rows) => rows.length));
  return [element("p", { class: "hint" }, `RMS of the residual over RMS of the torque, per joint, on ${held(studies)}. Each study has its own filter cut-off and its own held-out blocks.`),
    wide(element("table", {}, heads("Joint", ["Difference"]),
      element("tbody", {}, Array.from({ length: joints }, (_, index) => {
        const [left, right] = scores.map((rows) => rows[index]?.nrmse_of_rms_percent ?? null);
        return element("tr", {}, element("th", { scope: "row" }, index + 1),
          [left, right].map((value, place) => element("td", {}, amount(value, most, place + 1))),
          element("td", {}, left === null || right === null ? "–" : `${right > left ? "+" : ""}${number(right - left, 3)} points`));
      }))), "Error per joint")];
}

function amount(value, most, colour) {
  if (value === null) return "–";
  return element("span", { class: "amount" }, svg("svg", { viewBox: "0 0 100 8", preserveAspectRatio: "none", "aria-hidden": "true" },
    svg("rect", { class: `fill-${colour}`, width: (100 * value) / most, height: 8, rx: 1 })), relative(value));
}

function findings(studies) {
  const keyed = studies.map((one) => new Map((one.document.diagnosis?.findings ?? []).map((found) => [`${found.cause} ${found.joints}`, found])));
  const keys = [...new Set(keyed.flatMap((found) => [...found.keys()]))];
  if (!keys.length) return element("p", {}, "Neither study has findings.");
  return wide(element("table", { class: "sides" }, heads("Finding", ["Found in"]),
    element("tbody", {}, keys.map((key) => {
      const [left, right] = keyed.map((found) => found.get(key));
      const one = left ?? right;
      return element("tr", {}, element("th", { scope: "row" }, `${one.title}, joint ${one.joints.join(", ")}`),
        [left, right].map((found, place) => element("td", {}, found ? `${found.statement}.` : studies[place].document.diagnosis ? "not found" : "not diagnosed")),
        element("td", {}, left && right ? "both" : left ? "left only" : "right only"));
    }))), "Findings");
}

function table(studies, rows) {
  const only = studies.map((one, place) => one.document.base_parameters.filter((row) => !studies[1 - place].document.base_parameters.some((other) => other.name === row.name && other.unit === row.unit)).map((row) => row.name));
  if (!rows.length) return element("p", { class: "soft" }, `No common parameters: ${reasonApart(studies)}.`);
  return [element("p", { class: "hint" }, `z is the difference, right minus left, divided by its standard deviation. |z| > ${REAL} is significant.`),
    wide(element("table", { class: "parameters narrow" }, heads("Parameter", ["Difference", "z", element("span", { class: "visually-hidden" }, "z, drawn")]),
      element("tbody", {}, rows.map((row) => element("tr", {},
        element("th", { scope: "row" }, row.name, " ", element("span", { class: "unit" }, row.unit === "1" ? "" : row.unit)),
        [row.left, row.right].map((one) => element("td", {}, measured(one.value, one.standard_deviation))),
        element("td", {}, number(row.difference, 3)),
        element("td", { class: Math.abs(row.z) > REAL ? "poor" : null }, `${row.z > 0 ? "+" : ""}${number(row.z, 2)}`),
        element("td", {}, lollipop(row.z)))))), "Parameters"),
    only.map((names, place) => (names.length ? element("p", { class: "hint" }, `Only ${place ? "right" : "left"}: ${names.join(", ")}.`) : null))];
}

// Why two models have no parameter of one name and unit in common.
function reasonApart(studies) {
  const [left, right] = studies.map((one) => one.document.robot);
  const same = JSON.stringify(left.joints ?? left.links) === JSON.stringify(right.joints ?? right.links);
  return same
    ? "both studies are of the same robot, but their models have different terms, so no parameter has the same name and unit in both"
    : `the studies are of different robots, ${left.name} and ${right.name}, with different parameter groupings or units`;
}

function lollipop(z) {
  const end = 60 + (Math.max(-WIDEST, Math.min(WIDEST, z)) / WIDEST) * 56;
  const limits = [-REAL, REAL].map((one) => 60 + (one / WIDEST) * 56);
  return svg("svg", { class: "errorbar", viewBox: "0 0 120 16", "aria-hidden": "true" },
    svg("rect", { class: "band", x: limits[0], y: 2, width: limits[1] - limits[0], height: 12 }),
    svg("path", { class: Math.abs(z) > REAL ? "reach poor" : "reach", d: `M60 8H${end.toFixed(1)}` }),
    svg("circle", { class: Math.abs(z) > REAL ? "poor" : null, cx: end.toFixed(1), cy: 8, r: 3 }));
}

/** Pairs of numbers, from 1, of the logs that both studies used. */
function sharedLogs(studies) {
  const [left, right] = studies.map((one) => one.document.provenance.log_sha256);
  return left.map((sha256, index) => [index + 1, right.indexOf(sha256) + 1]).filter(([, other]) => other > 0);
}

function overlay(studies) {
  const [shared] = sharedLogs(studies);
  if (!shared) return element("p", { class: "soft" }, "The studies used different logs, so their torques cannot be overlaid.");
  if (!studies.every((one) => one.job.links.traces)) return element("p", { class: "soft" }, "One of the studies has no stored traces, so the torques cannot be overlaid.");
  const grid = element("div", { class: "tiles" });
  const near = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    near.disconnect();
    overlaid(grid, studies, shared).catch((error) => showError(grid, error));
  }, { rootMargin: "400px" });
  near.observe(grid);
  return [element("p", { class: "hint" }, `Log: ${studies[0].document.logs[shared[0] - 1].name}. The filtered torque is that of the left study.`), grid];
}

async function overlaid(grid, studies, logs) {
  const asked = studies.map((one) => tracesOf(one.job, one.document));
  const joints = Array.from({ length: Math.min(...asked.map((one) => one.joints)) }, (_, index) => index + 1);
  const seen = await Promise.all(joints.map((joint) => Promise.all(asked.map((one, place) => one.of(joint, logs[place])))));
  seen.forEach(([left, right], index) => {
    const place = element("div", { class: "tile" });
    grid.append(place);
    const estimated = (one, place) => one.values[asked[place].extended ? "torque_estimated_after" : "torque_estimated"];
    draw(place, {
      title: `Joint ${index + 1}`, unit: left.units.torque_filtered, height: 180, together: "compared", x: { label: "time", unit: "s", values: left.time }, extent: left.extent,
      traces: [
        { label: "filtered", values: left.values.torque_filtered, colour: 7, width: 2.4 },
        { label: "left", values: estimated(left, 0), colour: 1, width: 1.6 },
        { label: "right", values: estimated(right, 1), at: right.time, colour: 2, width: 1.6, dashed: true },
      ],
    });
  });
}
