// Keep the caller's key for as long as this tab lives, and ask for it where the service requires one.
import { element } from "./dom.js";

const NAME = "veritorque-key";
let asking = null;

/** The headers that carry the key; none where there is none. */
export function keyHeaders() {
  const key = sessionStorage.getItem(NAME);
  return key ? { Authorization: `Bearer ${key}` } : {};
}

/** Whether a key was given. */
export function hasKey() {
  return sessionStorage.getItem(NAME) !== null;
}

/**
 * Ask for the key in a dialog; many callers share one.
 * @param {Object} problem what the service said, shown above the field
 * @param {Object} refused the headers that were refused
 * @returns {Promise<boolean>} whether one was given, or had been since they were sent
 */
export async function askForKey(problem, refused) {
  if (asking === null && keyHeaders().Authorization !== refused.Authorization) return true;
  asking ??= dialog(problem).finally(() => {
    asking = null;
  });
  return asking;
}

function dialog(problem) {
  const field = element("input", {
    type: "password",
    id: "key",
    required: true,
    autocomplete: "current-password",
    spellcheck: "false",
  });
  const box = element(
    "dialog",
    { "aria-labelledby": "key-title" },
    element(
      "form",
      { method: "dialog" },
      element("h2", { id: "key-title" }, "This service requires an API key"),
      element(
        "p",
        {},
        `${capital(problem.cause)}. The operator creates one with `,
        element("code", {}, "veritorque keys create"),
        ". It is kept until this tab is closed.",
      ),
      element("label", { for: "key" }, "Key"),
      field,
      element(
        "div",
        { class: "actions" },
        element("button", { class: "primary", value: "use" }, "Use this key"),
        element("button", { type: "button", class: "quiet", on: { click: () => box.close("") } }, "Cancel"),
      ),
    ),
  );
  document.body.append(box);
  box.showModal();
  return new Promise((resolve) => {
    box.addEventListener("close", () => {
      const given = box.returnValue === "use" && field.value.trim() !== "";
      if (given) sessionStorage.setItem(NAME, field.value.trim());
      box.remove();
      resolve(given);
    });
  });
}

function capital(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
