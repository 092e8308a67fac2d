// Show what robot and logs disagree in, and correct it: the logs are read anew, the description is edited, the job is started again.
import { get, post } from "./api.js";
import { element, fill } from "./dom.js";
import { showError } from "./problem.js";
import { number, percent, plain } from "./words.js";

/** Show a card for every correction, with the conflicts that it removes; nothing where robot and logs agree. */
export function showConflicts(container, { job, document }) {
  fill(container, [...byCorrection(document.conflicts ?? [])].map(([text, conflicts]) => card(job, text, conflicts)));
}

// The corrections of all conflicts that a fit tells are one correction, so they are applied together.
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
  const said = element("div", { class: "said", "aria-live": "polite" });
  const apply = element("button", { type: "button", class: "primary", on: { click: begin } }, "Apply and start again");
  const copy = element("button", { type: "button", on: { click: copied } }, "Copy correction");
  const applied = conflicts.every((conflict) => conflict.applied);
  return element("section", { class: "card conflict", "aria-label": "Robot and log disagree" },
    conflicts.map(entry),
    element("p", {}, applied
      ? "All results below are computed with this correction. The stored log and robot are still as they were uploaded."
      : "The results below are computed without this correction."),
    element("div", { class: "actions" }, apply, copy, element("span", { class: "hint" }, edits(correction))),
    element("details", {}, element("summary", {}, "Correction"), element("pre", { tabindex: "0" }, element("code", {}, text))),
    said);

  async function begin() {
    apply.disabled = true;
    try {
      const { id } = await started(job, correction);
      location.assign(`/studies/${id}`);
    } catch (error) {
      showError(said, error);
      apply.disabled = false;
    }
  }

  async function copied() {
    try {
      await navigator.clipboard.writeText(text);
      fill(said, element("p", { class: "hint", role: "status" }, "The correction is on the clipboard."));
    } catch (error) {
      showError(said, error);
    }
  }
}

function entry(conflict) {
  const { error_before_percent: before, error_after_percent: after } = conflict;
  const fall = before === null ? "" : `, error ${number(before, 3)} → ${number(after, 3)}\u00a0%`;
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

async function started(job, correction) {
  const { mapping, mappings, robot } = correction;
  const logs = await Promise.all(job.logs.map((log, place) => readAgain(log, mappings?.[place] ?? (place === 0 ? mapping : {}))));
  return post("/v1/jobs", { kind: job.kind, robot: await described(job.robot, robot), logs, options: job.options });
}

async function readAgain(log, mapping) {
  if (!Object.keys(mapping).length) return log;
  return (await post(`/v1/logs/${encodeURIComponent(log)}/readings`, { mapping })).id;
}

async function described(robot, fields) {
  if (!Object.keys(fields).length) return robot;
  const { description } = await get(`/v1/robots/${encodeURIComponent(robot)}`);
  return (await post("/v1/robots", { ...description, ...fields })).id;
}

function capital(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
