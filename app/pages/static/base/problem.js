// Show a problem document as people read it: what is wrong, what to do, and the numbers that show it.
import { problemFrom } from "./api.js";
import { element, fill } from "./dom.js";

/** Show whatever was thrown in a container, and let screen readers say it. */
export function showError(container, error) {
  if (error?.name === "AbortError") return;
  if (!error?.problem) console.error(error);
  fill(container, problemBox(problemFrom(error)));
}

/** Draw a problem document. */
export function problemBox(problem) {
  const evidence = Object.entries(problem.evidence ?? {});
  return element(
    "section",
    { class: "problem", role: "alert" },
    element("h3", {}, problem.title),
    element("p", { class: "cause" }, sentence(problem.cause)),
    problem.remedy
      ? element("p", { class: "remedy" }, element("strong", {}, "Remedy: "), sentence(problem.remedy))
      : null,
    evidence.length ? element("details", {}, element("summary", {}, "Evidence"), list(problem.evidence)) : null,
  );
}

function list(object) {
  return element(
    "dl",
    { class: "evidence" },
    Object.entries(object).map(([name, value]) => [
      element("dt", {}, name.replaceAll("_", " ")),
      element("dd", {}, shown(value)),
    ]),
  );
}

function shown(value) {
  if (value === null) return "none";
  if (Array.isArray(value)) {
    return value.some((one) => one !== null && typeof one === "object")
      ? element(
          "ul",
          {},
          value.map((one) => element("li", {}, shown(one))),
        )
      : value.join(", ") || "none";
  }
  return typeof value === "object" ? list(value) : String(value);
}

function sentence(text) {
  const begun = text.charAt(0).toUpperCase() + text.slice(1);
  return /[.!?]$/.test(begun) ? begun : `${begun}.`;
}
