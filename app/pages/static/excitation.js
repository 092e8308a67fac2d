// What the motion excited, and what it left poorly known: as far as the result says, and no further.
import { element, fill } from "./dom.js";
import { relative } from "./headline.js";
import { number } from "./words.js";

const POOR_PERCENT = 30;
const MOST = 12;

/** Show condition numbers and the parameters that the motion tells least about. */
export function showExcitation(container, { document }) {
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
    poor.length ? table(poor) : element("p", {}, `Every base parameter is known within ${POOR_PERCENT} %.`),
    missing.length ? element("div", {}, element("h3", {}, "Motions that would show more"),
      element("ul", {}, missing.map((one) => element("li", {}, element("strong", {}, `${one.title}${one.joints.length ? `, joint ${one.joints.join(", ")}` : ""}: `), `${one.why}. `, one.separating_experiment ? `${capital(one.separating_experiment)}.` : "")))) : null);
}

function table(poor) {
  const shown = poor.slice(0, MOST);
  return element("div", { class: "wide scroll", tabindex: "0", role: "region", "aria-label": "Poorly known parameters" }, element("table", {},
    element("caption", {}, `Known worse than ${POOR_PERCENT} %${poor.length > MOST ? `; the first ${MOST} of ${poor.length}` : ""}. Own share: what is left of a parameter's trace in the torque once all others have explained what they can.`),
    element("thead", {}, element("tr", {}, ["Parameter", "%P", "Own share", "Why, and what would help"].map((name) => element("th", { scope: "col" }, name)))),
    element("tbody", {}, shown.map((row) => element("tr", {},
      element("th", { scope: "row" }, row.name),
      element("td", {}, relative(row.relative_deviation_percent)),
      element("td", {}, relative(row.own_share === undefined || row.own_share === null ? null : 100 * row.own_share)),
      element("td", {}, advice(row)))))));
}

function advice(row) {
  if (row.own_share === undefined || row.own_share === null) return "";
  if (row.own_share === 0) return "The motion does not excite it at all.";
  if (row.own_share < 0.1) return "Its trace is nearly a sum of other parameters' traces: move the joints in a way that tells them apart.";
  if (!row.essential) return "Its torque is too small beside the noise to matter for prediction on this motion.";
  return `Its torque is small beside the noise: ${row.unit === "kg m2" ? "accelerate joint" : row.unit === "kg m" ? "turn the links about more inclined axes of joint" : "move faster and longer at joint"} ${row.joint}.`;
}

function figure(big, small) {
  return element("div", {}, element("strong", {}, big), element("span", {}, small));
}

function capital(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
