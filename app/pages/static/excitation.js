// What the motion excited, and what it left poorly known: as far as the result says, and no further.
import { element, fill } from "./dom.js";
import { joints } from "./torque.js";
import { wide } from "./wide.js";
import { number, relative } from "./words.js";

const POOR_PERCENT = 30;
const ALIKE = 0.1;

/** Show condition numbers and the parameters that the motion tells least about. */
export async function showExcitation(container, study) {
  const { document } = study;
  const rows = document.base_parameters;
  const poor = rows.filter((row) => row.relative_deviation_percent === null || row.relative_deviation_percent > POOR_PERCENT)
    .sort((a, b) => (b.relative_deviation_percent ?? Infinity) - (a.relative_deviation_percent ?? Infinity));
  const missing = document.diagnosis?.not_identifiable ?? [];
  fill(container,
    element("div", { class: "figures" },
      figure(number(document.condition_number, 3), "condition number of the observation matrix, weighted, in SI units"),
      figure(number(document.condition_number_scaled, 3), "with columns scaled to equal length: how alike the parameters' traces are, whatever their units"),
      figure(`${rows.length - poor.length} of ${rows.length}`, `base parameters known within ${POOR_PERCENT} %`),
      document.precision ? figure(relative(document.precision.left_out_percent), "of the instants left out: standstill, and the ends that the filters reach beyond") : null),
    element("div", { class: "reached" }, await reached(study)),
    poor.length ? reasons(poor) : element("p", {}, `Every base parameter is known within ${POOR_PERCENT} %.`),
    missing.length ? element("div", {}, element("h3", {}, "Motions that would show more"),
      element("ul", {}, missing.map((one) => element("li", {}, element("strong", {}, `${one.title}${one.joints.length ? `, joint ${one.joints.join(", ")}` : ""}: `), `${one.why}. `, one.separating_experiment ? `${capital(one.separating_experiment)}.` : "")))) : null);
}

// Every poorly known parameter once, under the reason that the numbers give.
function reasons(poor) {
  const alike = (row) => row.own_share !== null && row.own_share !== undefined && row.own_share < ALIKE;
  const groups = [
    ["Not told apart", "Their traces in the torque are nearly sums of others'. A motion that moves these joints in other combinations would tell them apart.", (row) => alike(row)],
    ["Too small to matter here", "Not essential: without them the model predicts this motion as well. Only a faster motion, or one with another load, could show them.", (row) => !alike(row) && !row.essential],
    ["Needed, and not well known", "Essential, yet their torque is small beside the noise. A longer or faster motion of these joints would pin them down.", (row) => !alike(row) && row.essential],
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
    element("caption", {}, study.traces.logs > 1 ? "What the motion of the first log reached" : "What the motion reached"),
    element("thead", {}, element("tr", {}, ["Joint", "Position", "Largest speed", "Torque RMS"].map((name) => element("th", { scope: "col" }, name)))),
    element("tbody", {}, rows.map((one, index) => {
      const [low, high] = span(one.values.position);
      const [back, forth] = span(one.values.velocity);
      return element("tr", {}, element("th", { scope: "row" }, index + 1),
        element("td", {}, `${number(low, 3)} to ${number(high, 3)} ${one.units.position}`),
        element("td", {}, `${number(Math.max(-back, forth), 3)} ${one.units.velocity}`),
        element("td", {}, `${number(held[index].rms_torque, 3)} ${one.units.residual}`));
    }))), "What the motion reached");
}

function figure(big, small) {
  return element("div", {}, element("strong", {}, big), element("span", {}, small));
}

function capital(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
