// What a diagnosis found, as the report tells it: the same sentences, figures and tables, taken over from there.
import { element, fill } from "./dom.js";
import { copied } from "./headline.js";

/** Show the findings, each with its size, its figure before and after, its gain and its rivals; then joint by joint. */
export function showFindings(container, { document, report }) {
  const cards = [...report.querySelectorAll("article.finding")].map(copied);
  const none = element("p", {}, "Nothing was found that this log can show.");
  fill(container, element("div", { class: "told" }, cards.length ? cards : none, taken(report, "Joint by joint", "h3")));
  downgrade(container);
  if (!document.diagnosis.findings.length) return;
}

/** Show what stays unexplained, and what this motion could not have shown. */
export function showRemainder(container, { report }) {
  fill(container, element("div", { class: "told" }, taken(report, "What stays unexplained", null), taken(report, "could not", "h3")));
  downgrade(container);
}

function taken(report, heading, level) {
  const found = [...report.querySelectorAll("main > section")].find((one) => one.querySelector("h2")?.textContent.includes(heading));
  if (!found) return null;
  const [head, ...rest] = [...found.children];
  return [level ? element(level, {}, head.textContent) : null, ...rest.map(copied)];
}

// Wide tables scroll by themselves, and can be reached by keys to do so.
function downgrade(container) {
  for (const wide of container.querySelectorAll(".wide")) {
    wide.tabIndex = 0;
    wide.setAttribute("role", "region");
    wide.setAttribute("aria-label", wide.querySelector("caption")?.textContent ?? "Table");
  }
}
