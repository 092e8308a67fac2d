// Controls that several forms share.
import { element } from "./dom.js";

let last = 0;

/** An id that no other element of the page has. */
export function freshId(name) {
  last += 1;
  return `${name}-${last}`;
}

/** A field with its label above and an explanation below. */
export function field(label, control, hint = null) {
  control.id ||= freshId("field");
  const told = hint === null ? null : element("span", { class: "hint", id: `${control.id}-hint` }, hint);
  if (told) control.setAttribute("aria-describedby", told.id);
  return element("div", { class: "field" }, element("label", { for: control.id }, label), control, told);
}

/** A choice of one among a few, side by side. `choices` maps values to labels. */
export function segments(legend, choices, value, changed) {
  const name = freshId("choice");
  return element(
    "fieldset",
    { class: "switch" },
    element("legend", { class: "visually-hidden" }, legend),
    Object.entries(choices).map(([key, label]) => {
      const input = element("input", {
        type: "radio",
        name,
        value: key,
        checked: key === value,
        on: { change: () => changed(key) },
      });
      return element("label", {}, input, element("span", {}, label));
    }),
  );
}

/** A menu. `choices` are pairs of value and label; `value` is the one that stands first. */
export function menu(choices, value, changed, attributes = {}) {
  const made = element(
    "select",
    { ...attributes, on: { change: () => changed(made.value) } },
    choices.map(([key, label]) => element("option", { value: key, selected: key === value }, label)),
  );
  return made;
}

/** A place to drop files on, or to choose them with a click or a key. */
export function dropZone(label, hint, accept, taken) {
  const input = element("input", {
    type: "file",
    class: "visually-hidden",
    accept,
    on: {
      change: () => {
        give(input.files);
        input.value = "";
      },
    },
  });
  const zone = element(
    "label",
    { class: "drop" },
    input,
    element("strong", {}, label),
    element("span", { class: "hint" }, hint),
  );
  for (const [event, over] of [
    ["dragenter", true],
    ["dragover", true],
    ["dragleave", false],
    ["drop", false],
  ]) {
    zone.addEventListener(event, (happened) => {
      happened.preventDefault();
      zone.classList.toggle("over", over);
    });
  }
  zone.addEventListener("drop", (event) => give(event.dataTransfer.files));
  return zone;

  function give(files) {
    if (files.length) taken(files[0]);
  }
}

/** Ask for a number; what is typed stays as it is typed. */
export function figure(value, typed, more = {}) {
  return element("input", {
    ...more,
    type: "text",
    inputmode: "decimal",
    value: value ?? "",
    on: { input: (event) => typed(event.target.value) },
  });
}

/** Read a number as people write it: 1.5, 1,5, -pi/2, 2e-3; NaN where it is none. */
export function readNumber(text) {
  const written = text.trim().replace(",", ".").replaceAll("−", "-");
  const turn = /^([-+]?)(\d*\.?\d*)\s*\*?\s*(?:pi|π)(?:\s*\/\s*(\d+\.?\d*))?$/i.exec(written);
  if (turn)
    return ((turn[1] === "-" ? -1 : 1) * (turn[2] === "" ? 1 : Number(turn[2])) * Math.PI) / Number(turn[3] ?? 1);
  const quotient = /^([-+]?\d*\.?\d+)\/(\d*\.?\d+)$/.exec(written);
  const value = quotient ? Number(quotient[1]) / Number(quotient[2]) : Number(written);
  return written === "" || !Number.isFinite(value) ? NaN : value;
}
