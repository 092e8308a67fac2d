// Show what came out of a successful job.
import { follow } from "./api.js";
import { element, fill } from "./dom.js";

/**
 * Show the result of a job.
 * @param {HTMLElement} container
 * @param {Object} job as the API answers it
 */
export async function show(container, job) {
  fill(container, element("p", {}, follow(element("a", { class: "primary button", href: job.links.report }, "Read the report"))));
}
