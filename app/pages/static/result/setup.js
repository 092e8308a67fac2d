// Show a set-up check: whether robot and logs belong together, and which parameters and causes the logs can show.
import { element, fill } from "../base/dom.js";
import { warnings } from "./headline.js";
import { number, plain, plural, relative } from "../base/words.js";
import { scrolling } from "../drawing/wide.js";

const AGREEMENT = {
  yes: ["Robot and log belong together.", "good"],
  after_correction: ["Robot and log belong together once they are corrected as stated above.", null],
  doubtful: ["It is doubtful whether robot and log belong together.", "bad"],
};

/** Show the answer and the key figures. */
export function showAgreement(container, { job, document }) {
  const [verdict, kind] = AGREEMENT[document.agreement];
  const held = document.validation_total_percent ?? document.fit_total_percent;
  const sure = document.identifiable.filter((row) => row.identifiable === "yes").length;
  const seen = document.shown.filter((cause) => cause.visible).length;
  const wanted = new URLSearchParams([["robot", job.robot], ...job.logs.map((log) => ["log", log])]);
  fill(container, element("section", { class: "card headline", "aria-label": "Summary" },
    warnings(document),
    element("p", { class: `verdict ${kind ?? ""}` }, verdict),
    element("div", { class: "figures" },
      figure(relative(held), `torque error on ${document.validation.length ? "held-out" : "the fitted"} data, RMS of residual over RMS of torque`),
      figure(`${sure} of ${document.identifiable.length}`, "base parameters are identifiable from this motion"),
      document.shown.length ? figure(`${seen} of ${document.shown.length}`, "causes of simulation error would show in this log") : null),
    element("p", {}, element("a", { class: "button", href: `/new?${wanted}` }, "Continue with an analysis"))));
}

export const CHECKED = [
  ["errors", "Torque prediction error", showErrors],
  ["parameters", "Parameters", showIdentifiable],
  ["causes", "Causes", showCauses],
];

function figure(big, small) {
  return element("div", {}, element("strong", {}, big), element("span", {}, small));
}

function showErrors(container, { document }) {
  const held = new Map(document.validation.map((row) => [row.joint, row]));
  fill(container, table("Error of the predicted torque per joint", ["Joint", "RMS torque", "Fitted, % of RMS", "Held out, % of RMS", "Prediction"],
    document.fit.map((row) => [row.joint, number(row.rms_torque), relative(row.nrmse_of_rms_percent), relative(held.get(row.joint)?.nrmse_of_rms_percent), (held.get(row.joint) ?? row).quality ?? ""])));
}

function showIdentifiable(container, { document }) {
  const titles = { yes: "Identifiable", poorly: "Poorly identifiable", needs_motion: "Only with another motion" };
  fill(container, Object.entries(titles).map(([answer, title]) => {
    const rows = document.identifiable.filter((row) => row.identifiable === answer);
    return rows.length ? [
      element("h3", {}, `${title}: ${rows.length}`),
      element("ul", { class: "chips" }, rows.map((row) => element("li", { title: row.grouping }, `${row.name} ${row.relative_deviation_percent === null ? "" : relative(row.relative_deviation_percent)}`))),
    ] : null;
  }), element("p", { class: "hint" }, "The percentage is the standard deviation over the value. Poorly: above 30 %."));
}

function showCauses(container, { document }) {
  if (!document.shown.length) {
    fill(container, element("p", {}, "The log is too short for a diagnosis."));
    return;
  }
  fill(container,
    table("Causes that the log can show, and the approximate size from which they would be found", ["Cause", "Not on joints", "From", "Quantity"],
      document.shown.map((cause) => [cause.title, cause.visible ? cause.not_on_joints.join(", ") || "–" : "all", ...smallest(cause)])),
    element("h3", {}, "Causes that this log does not distinguish"),
    document.not_separable.length
      ? element("ul", {}, document.not_separable.map((pair) => element("li", {},
          element("strong", {}, `${pair.causes.map(plain).join(" and ")}${pair.joints.length ? ` (${plural("joint", pair.joints.length).replace(/^.* /, "")} ${pair.joints.join(", ")})` : ""}`),
          `: ${pair.why}. ${pair.answer === "never" ? "No motion separates them" : "Separating experiment"}: ${pair.experiment}.`)))
      : element("p", {}, "None."));
}

// The joint on which the smallest effect would be found stands for all.
function smallest({ smallest: sizes }) {
  if (!sizes.length) return ["–", ""];
  const falls = sizes.some((size) => size.bound === "at_most");
  const best = sizes.reduce((one, other) => (falls ? other.value > one.value : other.value < one.value) ? other : one);
  return [`${falls ? "≤ " : ""}${number(best.value, 2)}${best.unit === "1" ? "" : ` ${best.unit}`}`, `${plain(best.name)}${best.joints.length ? `, joint ${best.joints.join(", ")}` : ""}`];
}

function table(caption, headings, rows) {
  return scrolling(element("div", { class: "wide" }, element("table", { class: "checked" },
    element("caption", {}, caption),
    element("thead", {}, element("tr", {}, headings.map((heading) => element("th", { scope: "col" }, heading)))),
    element("tbody", {}, rows.map(([head, ...cells]) => element("tr", {}, element("th", { scope: "row" }, String(head)), cells.map((cell) => element("td", {}, String(cell)))))))), caption);
}
