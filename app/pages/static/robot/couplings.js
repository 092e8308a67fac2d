// The form for coupled motors: each turns with a weighted sum of joints, as motor 6 of a Staubli TX40 with q5 + q6.
import { field, readNumber } from "../base/controls.js";
import { element, fill } from "../base/dom.js";
import { plural } from "../base/words.js";

/**
 * Make the form.
 * @param {Object[]} couplings as a description holds them
 * @param {function(): void} changed called at every change
 * @returns {{node: HTMLElement, read: function(number): {couplings: Object[], fault: (string|null)}, use: function(Object[]): void}}
 *   `read` takes the number of joints
 */
export function couplingForm(couplings, changed) {
  let rows = couplings.map(written);
  const list = element("div", { class: "stack" });
  const node = element("div", { class: "stack" },
    element("p", { class: "hint" }, "A motor that turns with several joints: its angle is the weighted sum of their positions. ",
      "Its inertia and friction are identified as IAM, FVM and FCM. Staubli TX40: joints 5, 6 with weights 1 1."),
    list,
    element("div", { class: "actions" }, element("button", { type: "button", on: { click: add } }, "Add a coupled motor")));
  show();
  return {
    node,
    read: (joints) => readRows(rows, joints),
    use(others) {
      rows = others.map(written);
      show();
    },
  };

  function show() {
    fill(list, rows.map(line));
  }

  function line(row, index) {
    const input = (name, label, hint, placeholder) =>
      field(`Motor ${index + 1}: ${label}`, element("input", {
        type: "text", spellcheck: "false", value: row[name], placeholder,
        on: { input: (event) => { row[name] = event.target.value; changed(); } },
      }), hint);
    return element("div", { class: "fields coupling" },
      input("name", "name", null, "motor 6"),
      input("joints", "joints", "counted from 1", "5, 6"),
      input("weights", "weights", "one per joint, separated by spaces", "1 1"),
      element("button", { type: "button", class: "tiny", "aria-label": `Remove motor ${index + 1}`, on: { click: () => remove(index) } }, "✕"));
  }

  function add() {
    rows.push({ name: `motor ${rows.length + 1}`, joints: "", weights: "1 1" });
    show();
    list.lastElementChild.querySelectorAll("input")[1].focus();
    changed();
  }

  function remove(index) {
    rows.splice(index, 1);
    show();
    changed();
  }
}

/** Say coupled motors in words. */
export function couplingWords(couplings) {
  return couplings.map(({ name, joints, weights }) =>
    `${name}: ${joints.map((joint, place) => `${signed(weights[place], place)}q${joint}`).join(" ")}`);
}

function signed(weight, place) {
  const sign = weight < 0 ? "−" : place ? "+" : "";
  const size = Math.abs(weight) === 1 ? "" : `${Math.abs(weight)} `;
  return place ? `${sign} ${size}` : `${sign}${size}`;
}

function written({ name, number, joints, weights }) {
  return { name, number, given: joints.join(), joints: joints.join(", "), weights: weights.join(" ") };
}

function readRows(rows, count) {
  const couplings = [];
  for (const [index, row] of rows.entries()) {
    const joints = row.joints.split(/[,;\s]+/).filter(Boolean).map(Number);
    const weights = row.weights.split(/[;\s]+|,(?=\s)/).filter(Boolean).map(readNumber);
    const fault = faultOf(joints, weights, count);
    if (fault) return { couplings: [], fault: `Motor ${index + 1} ${fault}.` };
    const number = row.number !== undefined && row.given === joints.join() ? { number: row.number } : {};
    couplings.push({ name: row.name.trim() || `motor ${index + 1}`, ...number, joints, weights });
  }
  return { couplings, fault: null };
}

function faultOf(joints, weights, count) {
  if (joints.length < 2 || new Set(joints).size < joints.length) return "needs at least two different joints";
  if (!joints.every((joint) => Number.isInteger(joint) && joint >= 1 && joint <= count)) return `names a joint that is none of the ${plural("joint", count)}`;
  if (weights.length !== joints.length || !weights.every(Number.isFinite)) return "needs one number per joint as weights, separated by spaces";
  return null;
}
