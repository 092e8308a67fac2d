// Show the findings of a diagnosis: sentences, figures and tables copied from the report.
import { correctionActions } from "../study/again.js";
import { element, fill } from "../base/dom.js";
import { copied } from "./headline.js";
import { scrolling } from "../drawing/wide.js";
import { number } from "../base/words.js";

/** Show the findings, each with its size, figure, improvement and alternatives; then the errors per joint. */
export function showFindings(container, { job, document, report }) {
  const cards = [...report.querySelectorAll("article.finding")].map(copied);
  const none = element("p", {}, "No cause was found in this log.");
  fill(container, corrected(job, document.diagnosis), document.diagnosis.findings?.map(loads), element("div", { class: "told" }, cards.length ? cards : none, taken(report, "Errors per joint", "h3")));
  reachable(container);
}

const CONTROLLERS = { ur: "Universal Robots, URScript", abb: "ABB, RAPID", kuka: "KUKA, KRL", staubli: "Staubli, VAL 3" };

/** Write the largest of some standard deviations behind a number. */
function within(deviations) {
  return deviations.length && deviations.every(Number.isFinite) ? ` ± ${number(Math.max(...deviations), 2)}` : "";
}

// The body of a payload as controllers take it, in the frame of the flange where one is named.
function loads({ payload, parameters }) {
  if (!payload) return null;
  const deviations = (begin) => parameters.filter(({ name }) => name.startsWith(begin)).map((one) => one.standard_deviation);
  const flange = payload.frames.find(({ frame }) => frame === payload.flange);
  const shown = flange ?? payload.frames[0];
  const centre = shown.center_of_mass.map((value) => number(value, 3)).join(", ");
  return element("section", { class: "card", "aria-label": "Payload for the controller" },
    element("h3", {}, "Payload for the controller"),
    element("p", {}, `${number(payload.mass)}${within(deviations("mass"))} kg, mass centre at ${centre}${within(deviations("com_"))} m in the frame ${shown.frame}.`,
      payload.removed ? " The body was removed: subtract it from what the controller has." : null,
      payload.inertia_known ? null : " The motion does not determine its inertia: zero is written."),
    flange ? null : element("p", { class: "hint" }, "No frame of this link is named tool0 or flange: name it in frames of the description."),
    Object.entries(shown.paste).map(([name, text]) => element("details", {}, element("summary", {}, CONTROLLERS[name] ?? name),
      element("pre", { tabindex: "0" }, element("code", {}, text)))),
    flange ? element("p", { class: "hint" }, "Compared with the makers' documentation, not tried on a controller.") : null);
}

// What the findings correct in the description belongs together: all of it is in the repaired robot.
function corrected(job, { repairs, repaired_robot: robot }) {
  if (!robot) return null;
  const own = repairs.filter(({ mends }) => mends === "robot");
  return element("section", { class: "card conflict", "aria-label": "Correction of the robot's description" },
    element("h3", {}, "Correction of the robot's description"),
    element("ul", {}, own.map(({ what }) => element("li", {}, `${what}.`))),
    correctionActions(job, { mapping: {}, robot }, "Changes the description of the robot, as a copy."));
}

/** Show the unexplained residual and the causes that are not identifiable from this motion. */
export function showRemainder(container, { report }) {
  fill(container, element("div", { class: "told" }, taken(report, "Unexplained residual", null), taken(report, "Not identifiable", "h3")));
  reachable(container);
}

function taken(report, heading, level) {
  const found = [...report.querySelectorAll("main > section")].find((one) => one.querySelector("h2")?.textContent.includes(heading));
  if (!found) return null;
  const [head, ...rest] = [...found.children];
  return [level ? element(level, {}, head.textContent) : null, ...rest.map(copied)];
}

function reachable(container) {
  for (const region of container.querySelectorAll(".wide")) scrolling(region, region.querySelector("caption")?.textContent ?? "Table");
}
