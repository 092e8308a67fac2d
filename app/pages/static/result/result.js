// Show the result of a successful job: conflicts and headline first, then one section for each topic.
import { get, request } from "../base/api.js";
import { AUDITED, showAudit } from "./audit.js";
import { showBodies } from "./bodies.js";
import { showConflicts } from "./conflicts.js";
import { element, fill } from "../base/dom.js";
import { COMPARED, showComparison } from "./estimators.js";
import { showExcitation } from "./excitation.js";
import { showFindings, showRemainder } from "./findings.js";
import { showHeadline } from "./headline.js";
import { JOINT, showJoint } from "./joint.js";
import { showParameters } from "./parameters.js";
import { CHECKED, showAgreement } from "./setup.js";
import { showError } from "../base/problem.js";
import { showResiduals } from "./residuals.js";
import { showExport } from "./export.js";
import { showMotion, showTorque } from "./torque.js";
import { tracesOf } from "./traces.js";

/**
 * Show the result of a job.
 * @param {HTMLElement} container
 * @param {Object} job as the API answers it
 */
export async function show(container, job) {
  fill(container, element("p", { class: "waiting", role: "status" }, "Loading the result …"));
  const [document, report] = await Promise.all([get(job.links.results, { headers: { Accept: "application/json" } }), reportOf(job)]);
  const study = { job, document, report, traces: tracesOf(job, document) };
  const own = OWN[document.kind];
  const all = own ? own.sections : document.diagnosis ? [...DIAGNOSED, ...COMMON] : COMMON;
  const sections = job.links.traces ? all : all.filter(([id]) => !TRACED.has(id));
  const conflicts = element("div", {});
  const headline = element("div", {});
  const parts = sections.map(([id, title]) => element("section", { class: "card part", id, "aria-labelledby": `${id}-title` },
    element("h2", { id: `${id}-title` }, title), element("div", { class: "content" })));
  fill(container, conflicts, headline, contents(sections), parts);
  showConflicts(conflicts, study);
  (own?.headline ?? showHeadline)(headline, study);
  sections.forEach(([, , draw], place) => whenSeen(parts[place], (content) => draw(content, study)));
}

// Kinds whose result is no identified robot.
const OWN = {
  check: { sections: CHECKED, headline: showAgreement },
  audit: { sections: AUDITED, headline: showAudit },
  compare: { sections: COMPARED, headline: showComparison },
  joint_model: { sections: JOINT, headline: showJoint },
};
const DIAGNOSED = [
  ["findings", "Findings", showFindings],
  ["remainder", "Unexplained residual", showRemainder],
];
const COMMON = [
  ["torque", "Torque", showTorque],
  ["parameters", "Parameters", showParameters],
  ["residuals", "Residuals", showResiduals],
  ["bodies", "Bodies", showBodies],
  ["excitation", "Excitation", showExcitation],
  ["motion", "Motion", showMotion],
  ["export", "Export", showExport],
];

// Of these there is nothing to draw where a job kept its result alone.
const TRACED = new Set(["torque", "residuals", "motion"]);

async function reportOf(job) {
  if (!job.links.report) return null;
  const text = await (await request(job.links.report)).text();
  const unstyled = text.replace(/<style>.*?<\/style>/s, ""); // the page's own styles serve what is taken over
  return new DOMParser().parseFromString(unstyled, "text/html"); // inert: nothing of it runs or is loaded
}

function contents(sections) {
  return element("nav", { class: "contents", "aria-label": "Sections of the result" },
    sections.map(([id, title]) => element("a", { href: `#${id}` }, title)));
}

// What lies far below is drawn when it comes near, so that the first screen is there at once.
function whenSeen(section, draw) {
  const content = section.querySelector(".content");
  const seen = new IntersectionObserver(async (entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    seen.disconnect();
    try {
      await draw(content);
    } catch (error) {
      showError(content, error);
    }
    section.dataset.drawn = "true";
  }, { rootMargin: "400px" });
  seen.observe(section);
}
