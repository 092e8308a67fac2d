// Show an audit of a description: which bodies are impossible, and which entries logs contradict.
import { correctionActions } from "../study/again.js";
import { post } from "../base/api.js";
import { element, fill } from "../base/dom.js";
import { warnings } from "./headline.js";
import { showError } from "../base/problem.js";
import { number, plural, relative } from "../base/words.js";
import { scrolling } from "../drawing/wide.js";

/** Offer to audit the bodies of a robot without a log. */
export function auditOf(robot) {
  const said = element("div", { class: "said", "aria-live": "polite" });
  const start = element("button", { type: "button", on: { click: begin } }, "Audit the bodies");
  return element("div", { class: "coupled" }, start, said);

  async function begin() {
    start.disabled = true;
    try {
      fill(said, remarksOf(await post(`/v1/robots/${encodeURIComponent(robot.id)}/audit`, {})),
        element("p", { class: "hint" }, "With a log, the analysis “Audit of the description” finds what the motion contradicts."));
    } catch (error) {
      showError(said, error);
    }
    start.disabled = false;
  }
}

/** Show what was found in a sentence, the warnings, and the correction to apply. */
export function showAudit(container, { job, document }) {
  const { contradicted, corrected_robot: robot, judged } = document;
  const held = document.validation_total_percent ?? document.fit_total_percent;
  const verdict = !judged
    ? "The log does not allow a judgement of the description."
    : contradicted.length
      ? `The log contradicts ${plural("entry", contradicted.length).replace("entrys", "entries")} of the description.`
      : "The log contradicts no entry of the description.";
  const kind = contradicted.length ? "bad" : judged ? "good" : "";
  fill(container, element("section", { class: "card headline", "aria-label": "Summary" },
    warnings(document),
    element("p", { class: `verdict ${kind}` }, verdict),
    judged ? null : element("p", {}, `Reason: ${document.not_judged_because}.`),
    element("div", { class: "figures" },
      element("div", {}, element("strong", {}, relative(held)), element("span", {}, "torque error of the identified bodies on held-out data")),
      document.total_mass.described === null ? null
        : element("div", {}, element("strong", {}, `${number(document.total_mass.described)} kg`), element("span", {}, "moving links together, as described"))),
    robot ? correctionActions(job, { mapping: {}, robot }, "Changes only these entries, in a copy of the robot.", JSON.stringify(robot, null, 1)) : null));
}

export const AUDITED = [
  ["contradicted", "Contradicted entries", showContradicted],
  ["remarks", "The description by itself", (container, { document }) => fill(container, remarksOf(document))],
  ["combinations", "Identifiable combinations", showCombinations],
];

function remarksOf({ remarks, bodies_described: described, total_mass: total }) {
  if (!described) return element("p", {}, "The description gives no masses and inertias.");
  if (!remarks.length) return element("p", {}, `Every body is physically possible. The moving links weigh ${number(total.described)} kg together.`);
  return element("ul", {}, remarks.map(({ statement, remedy }) => element("li", {}, `${statement}. Remedy: ${remedy}.`)));
}

function showContradicted(container, { document: { contradicted } }) {
  if (!contradicted.length) {
    fill(container, element("p", {}, "None."));
    return;
  }
  fill(container, element("ul", {}, contradicted.map(({ statement, ambiguous_with: others }) => element("li", {},
    `${capital(statement)}.`,
    others.length ? ` Not distinguishable from: ${others.map(({ entry, link }) => `${entry} of link ${link}`).join(", ")}.` : null))));
}

function showCombinations(container, { document: { combinations } }) {
  const caption = "Combinations of bodies, as described and as measured";
  const heads = ["Name", "Described", "Measured", "Deviation", "Unit", "Contradicted"];
  fill(container, scrolling(element("div", { class: "wide" }, element("table", { class: "checked" },
    element("caption", {}, caption),
    element("thead", {}, element("tr", {}, heads.map((head) => element("th", { scope: "col" }, head)))),
    element("tbody", {}, combinations.map((row) => element("tr", {},
      element("th", { scope: "row", title: row.grouping }, row.name),
      [number(row.described), number(row.measured), number(row.standard_deviation), row.unit, row.contradicted ? "yes" : "–"].map((cell) =>
        element("td", {}, cell))))))), caption));
}

function capital(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
