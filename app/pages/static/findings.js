// Show the findings of a diagnosis: sentences, figures and tables copied from the report.
import { correctionActions } from "./again.js";
import { element, fill } from "./dom.js";
import { copied } from "./headline.js";
import { scrolling } from "./wide.js";

/** Show the findings, each with its size, figure, improvement and alternatives; then the errors per joint. */
export function showFindings(container, { job, document, report }) {
  const cards = [...report.querySelectorAll("article.finding")].map(copied);
  const none = element("p", {}, "No cause was found in this log.");
  fill(container, corrected(job, document.diagnosis), element("div", { class: "told" }, cards.length ? cards : none, taken(report, "Errors per joint", "h3")));
  reachable(container);
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
