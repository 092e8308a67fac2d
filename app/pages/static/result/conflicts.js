// Show what robot and logs disagree in, and correct it: the logs are read anew, the description is edited, the job is started again.
import { correctionActions } from "../study/again.js";
import { element, fill } from "../base/dom.js";
import { number, percent, plain } from "../base/words.js";

/** Show a card for every correction, with the conflicts that it removes; nothing where robot and logs agree. */
export function showConflicts(container, { job, document }) {
  fill(container, [...byCorrection(document.conflicts ?? [])].map(([text, conflicts]) => card(job, text, conflicts)));
}

// Conflicts that the service corrects together hold the same correction, and one click takes it.
function byCorrection(conflicts) {
  const groups = new Map();
  for (const conflict of conflicts) {
    const text = JSON.stringify(held(conflict.correction), null, 1);
    groups.set(text, [...(groups.get(text) ?? []), conflict]);
  }
  return groups;
}

function card(job, text, conflicts) {
  const { correction } = conflicts[0];
  const applied = conflicts.filter((conflict) => conflict.applied).length;
  return element("section", { class: "card conflict", "aria-label": "Robot and log disagree" },
    conflicts.map(entry),
    element("p", {}, COMPUTED[applied === conflicts.length ? "with" : applied ? "partly" : "without"]),
    text === NOTHING ? null : correctionActions(job, correction, edits(correction), text),
    text === NOTHING ? null : element("details", {}, element("summary", {}, "Correction"), element("pre", { tabindex: "0" }, element("code", {}, text))));
}

// The text of a correction that holds nothing to paste: what disagrees is corrected outside.
const NOTHING = "{}";

const COMPUTED = {
  with: "All results below are computed with this correction. The stored log and robot are still as they were uploaded.",
  partly: "All results below are computed with this correction, except that of the clock. The stored log and robot are still as they were uploaded.",
  without: "The results below are computed without this correction.",
};

function entry(conflict) {
  const { error_before_percent: before, error_after_percent: after } = conflict;
  const fall = before === null || after >= before ? "" : `, error ${number(before, 3)} → ${number(after, 3)}\u00a0%`;
  return [
    element("h2", {}, `Robot and log disagree: ${conflict.remedy}${fall}`),
    element("p", {}, `${capital(conflict.statement)}. Confidence ${percent(conflict.confidence)}.`),
    conflict.ambiguous_with.length
      ? element("div", {}, element("p", {}, "Not distinguishable from:"), element("ul", {}, conflict.ambiguous_with.map((other) =>
          element("li", {}, `${plain(other.conflict)}${other.joints.length ? ` (joint ${other.joints.join(", ")})` : ""}: ${other.why}.`))))
      : null,
  ];
}

function edits(correction) {
  const parts = [Object.keys(correction.mapping).length ? "the mapping of the log" : null, ...Object.keys(correction.robot).map((field) => `${plain(field)} of the robot`)];
  return `Changes ${parts.filter(Boolean).join(" and ")}, as a copy.`;
}

// What a correction holds; empty parts are nothing to paste.
function held(correction) {
  return Object.fromEntries(Object.entries(correction).filter(([, part]) => part && Object.keys(part).length));
}

function capital(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
