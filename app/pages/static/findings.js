// What a diagnosis found, as the report tells it: the same sentences, figures and tables, taken over from there.
import { element, fill } from "./dom.js";
import { copied } from "./headline.js";
import { scrolling } from "./wide.js";

/** Show the findings, each with its size, its figure before and after, its gain and its rivals; then joint by joint. */
export function showFindings(container, { report }) {
  const cards = [...report.querySelectorAll("article.finding")].map(copied);
  const none = element("p", {}, "Nothing was found that this log can show.");
  fill(container, element("div", { class: "told" }, cards.length ? cards : none, taken(report, "Joint by joint", "h3")));
  reachable(container);
}

/** Show what stays unexplained, and what this motion could not have shown. */
export function showRemainder(container, { report }) {
  fill(container, element("div", { class: "told" }, taken(report, "What stays unexplained", null), taken(report, "could not", "h3")));
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
