// Start a job again with a correction: logs are read anew by another mapping, the robot is copied with other fields.
import { get, post } from "../base/api.js";
import { element, fill } from "../base/dom.js";
import { showError } from "../base/problem.js";

/**
 * Offer to apply a correction, and to copy it.
 * @param {Object} job that is started again
 * @param {Object} correction `mapping` of the first log or `mappings` of all, and the fields of the `robot` to replace
 * @param {string} hint what is changed
 * @param {string|null} text to copy; null where there is nothing to paste
 */
export function correctionActions(job, correction, hint, text = null) {
  const said = element("div", { class: "said", "aria-live": "polite" });
  const apply = element("button", { type: "button", class: "primary", on: { click: begin } }, "Apply and start again");
  const copy = text === null ? null : element("button", { type: "button", on: { click: copied } }, "Copy correction");
  return [element("div", { class: "actions" }, apply, copy, element("span", { class: "hint" }, hint)), said];

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
