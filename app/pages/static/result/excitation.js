// Show the excitation: condition numbers, range of the motion, and poorly determined parameters with the reason.
import { element, fill } from "../base/dom.js";
import { joints } from "./torque.js";
import { wide } from "../drawing/wide.js";
import { number, relative } from "../base/words.js";

const POOR_PERCENT = 30;
const ALIKE = 0.1;

/** Show condition numbers and the parameters that the motion determines poorly. */
export async function showExcitation(container, study) {
  const { document } = study;
  const rows = document.base_parameters;
  const poor = rows.filter((row) => row.relative_deviation_percent === null || row.relative_deviation_percent > POOR_PERCENT)
    .sort((a, b) => (b.relative_deviation_percent ?? Infinity) - (a.relative_deviation_percent ?? Infinity));
  const missing = document.diagnosis?.not_identifiable ?? [];
  fill(container,
    element("div", { class: "figures" },
      figure(number(document.condition_number, 3), "condition number of the weighted observation matrix, in SI units"),
      figure(number(document.condition_number_scaled, 3), "condition number with columns scaled to unit norm, independent of the parameters' units"),
      figure(`${rows.length - poor.length} of ${rows.length}`, `base parameters with a relative standard deviation below ${POOR_PERCENT} %`),
      document.precision ? figure(relative(document.precision.left_out_percent), "of the samples excluded: standstill, and filter transients at the ends of segments") : null),
    element("div", { class: "reached" }, await reached(study)),
    poor.length ? reasons(poor) : element("p", {}, `Every base parameter has a relative standard deviation below ${POOR_PERCENT} %.`),
    missing.length ? element("div", {}, element("h3", {}, "Motions that would identify more"),
      element("ul", {}, missing.map((one) => element("li", {}, element("strong", {}, `${one.title}${one.joints.length ? `, joint ${one.joints.join(", ")}` : ""}: `), `${one.why}. `, one.separating_experiment ? `${capital(one.separating_experiment)}.` : "")))) : null);
}

// Group poorly determined parameters by reason.
function reasons(poor) {
  const alike = (row) => row.own_share !== null && row.own_share !== undefined && row.own_share < ALIKE;
  const groups = [
    ["Strongly correlated", "Their columns of the observation matrix are nearly linear combinations of others. A motion that moves these joints in other combinations would separate them.", (row) => alike(row)],
    ["Not significant", "Not essential: the model predicts this motion equally well without them. A faster motion or another payload may make them significant.", (row) => !alike(row) && !row.essential],
    ["Significant, poorly determined", "Essential, but their torque is small compared with the noise. A longer or faster motion of these joints would reduce their standard deviation.", (row) => !alike(row) && row.essential],
  ];
  return element("div", { class: "reasons" }, groups.map(([title, why, belongs]) => {
    const own = poor.filter(belongs);
    return own.length ? element("div", {}, element("h3", {}, title), element("p", { class: "hint" }, why),
      element("ul", { class: "chips" }, own.map((row) => element("li", {}, row.name, " ", element("span", { class: "soft" }, relative(row.relative_deviation_percent)))))) : null;
  }));
}

async function reached(study) {
  if (!study.job.links.traces) return null;
  const rows = await Promise.all(joints(study).map((joint) => study.traces.of(joint)));
  const span = (values) => { const known = values.filter((value) => value !== null); return [Math.min(...known), Math.max(...known)]; };
  const held = study.document.fit;
  return wide(element("table", {},
    element("caption", {}, study.traces.logs > 1 ? "Range of the motion in the first log" : "Range of the motion"),
    element("thead", {}, element("tr", {}, ["Joint", "Position", "Maximum speed", "Torque RMS"].map((name) => element("th", { scope: "col" }, name)))),
    element("tbody", {}, rows.map((one, index) => {
      const [low, high] = span(one.values.position);
      const [back, forth] = span(one.values.velocity);
      return element("tr", {}, element("th", { scope: "row" }, index + 1),
        element("td", {}, `${number(low, 3)} to ${number(high, 3)} ${one.units.position}`),
        element("td", {}, `${number(Math.max(-back, forth), 3)} ${one.units.velocity}`),
        element("td", {}, `${number(held[index].rms_torque, 3)} ${one.units.residual}`));
    }))), "Range of the motion");
}

function figure(big, small) {
  return element("div", {}, element("strong", {}, big), element("span", {}, small));
}

function capital(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
