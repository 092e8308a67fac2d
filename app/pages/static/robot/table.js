// The form for a modified Denavit-Hartenberg table: one row per joint, in the units of the data sheet, drawn while it is typed.
import { get } from "../base/api.js";
import { field, freshId, menu, readNumber, segments } from "../base/controls.js";
import { couplingForm } from "./couplings.js";
import { element, fill } from "../base/dom.js";
import { showError } from "../base/problem.js";
import { COLUMNS, EMPTY, factorOf, faultOf, jointOf, pointerOf, rowsOf, unitOf, without } from "./rows.js";

/**
 * Show the form.
 * @param {HTMLElement} container
 * @param {Object} options `known`: robots to start from; `changed(description)` called at every change, of null where it says no robot;
 *   `finished(description, refused)` is asked to keep it, and calls `refused(pointer)` if the service refuses it
 */
export function robotTable(container, { known, changed, finished }) {
  const units = { angle: "deg", length: "m" };
  let rows = [
    { ...EMPTY, r: 0.3 },
    { ...EMPTY, alpha: -Math.PI / 2 },
    { ...EMPTY, d: 0.4 },
  ];
  let more = false;
  const name = element("input", { type: "text", value: "my robot", maxlength: "100", on: { input: tell } });
  const gravity = element("input", { type: "text", value: "0, 0, -9.81", on: { input: tell } });
  const body = element("tbody", {});
  const head = element("thead", {});
  const motors = couplingForm([], tell);
  const motorsPart = element("details", {}, element("summary", {}, "Coupled motors"), motors.node);
  const wrong = element("p", { class: "hint wrong", role: "status" });
  const note = element("div", { class: "hint", role: "status" });
  const starts = [["", "an example with three joints"], ...known.map((robot) => [robot.id, robot.name])];

  fill(
    container,
    element(
      "div",
      { class: "fields" },
      field("Name", name),
      field("Gravity, m/s²", gravity, "x, y, z in the base frame; points down on a level base"),
      field("Start from", menu(starts, "", startFrom)),
    ),
    note,
    element(
      "div",
      { class: "row" },
      element("span", { class: "label" }, "Angles in"),
      segments("Unit of angles", { deg: "degrees", rad: "rad" }, "deg", (unit) => {
        units.angle = unit;
        show();
      }),
      element("span", { class: "label" }, "Lengths in"),
      segments("Unit of lengths", { m: "m", mm: "mm" }, "m", (unit) => {
        units.length = unit;
        show();
      }),
      element(
        "label",
        {},
        element("input", {
          type: "checkbox",
          on: {
            change: (event) => {
              more = event.target.checked;
              show();
            },
          },
        }),
        " more columns",
      ),
    ),
    element(
      "p",
      { class: "hint" },
      "Khalil-Kleinfinger notation: ",
      element("strong", {}, "d"),
      " is the distance along x (Craig: a); ",
      element("strong", {}, "r"),
      " is the distance along z (Craig: d). A revolute joint adds its coordinate to theta, a prismatic joint to r.",
    ),
    element(
      "div",
      { class: "wide", tabindex: "0", role: "group", "aria-label": "Table of the joints" },
      element("table", { class: "mdh" }, head, body),
    ),
    motorsPart,
    element(
      "div",
      { class: "actions" },
      element("button", { type: "button", on: { click: add } }, "Add a joint"),
      element("button", { type: "button", class: "primary", on: { click: finish } }, "Use this robot"),
      wrong,
    ),
  );
  show();

  function show() {
    const columns = COLUMNS.filter((column) => more || !column.more);
    fill(
      head,
      element(
        "tr",
        {},
        ["joint", "type", "antecedent"].map((label) => element("th", { scope: "col" }, label)),
        columns.map((column) =>
          element(
            "th",
            { scope: "col" },
            `${column.label ?? column.name}`,
            " ",
            element("span", { class: "unit" }, unitOf(column, rows, units)),
            column.hint ? element("span", { class: "colhint" }, column.hint) : null,
          ),
        ),
        element("th", { scope: "col" }, element("span", { class: "visually-hidden" }, "Remove")),
      ),
    );
    fill(
      body,
      rows.map((row, index) => line(row, index, columns)),
    );
    tell();
  }

  function line(row, index, columns) {
    const carriers = ["base", ...rows.slice(0, index).map((_, at) => `joint ${at + 1}`)].map((label, at) => [
      String(at),
      label,
    ]);
    return element(
      "tr",
      {},
      element("th", { scope: "row" }, index + 1),
      element(
        "td",
        {},
        menu(
          [
            ["revolute", "revolute"],
            ["prismatic", "prismatic"],
          ],
          row.type,
          (type) => {
            row.type = type;
            show();
          },
          { "aria-label": `Joint ${index + 1}: type` },
        ),
      ),
      element(
        "td",
        {},
        menu(
          carriers,
          String(row.antecedent ?? index),
          (carrier) => {
            row.antecedent = Number(carrier);
            tell();
          },
          { "aria-label": `Joint ${index + 1}: antecedent` },
        ),
      ),
      columns.map((column) => element("td", {}, cell(row, index, column))),
      element(
        "td",
        {},
        element(
          "button",
          {
            type: "button",
            class: "tiny",
            "aria-label": `Remove joint ${index + 1}`,
            disabled: rows.length === 1,
            on: { click: () => remove(index) },
          },
          "✕",
        ),
      ),
    );
  }

  function cell(row, index, column) {
    const factor = factorOf(column, row, units);
    const value = row[column.name];
    const input = element("input", {
      type: "text",
      inputmode: "decimal",
      class: "figure-input",
      id: freshId("cell"),
      "data-pointer": pointerOf(index, column),
      value:
        value === undefined ? "" : typeof value === "string" ? value : String(Number((value / factor).toPrecision(10))),
      "aria-label": [`Joint ${index + 1}: ${column.label ?? column.name}`, unitOf(column, [row], units)].filter(Boolean).join(", "),
      on: {
        input: () => {
          const read = readNumber(input.value);
          const empty = column.optional && input.value.trim() === "";
          row[column.name] = empty ? undefined : Number.isFinite(read) ? read * factor : input.value;
          input.ariaInvalid = !empty && !Number.isFinite(read) ? "true" : null;
          tell();
        },
      },
    });
    return input;
  }

  function tell() {
    changed(describe());
  }

  function describe() {
    const down = gravity.value
      .split(/[,;\s]+/)
      .filter(Boolean)
      .map(readNumber);
    const coupled = motors.read(rows.length);
    const isVector = down.length === 3 && down.every(Number.isFinite);
    const fault = isVector ? (faultOf(rows) ?? coupled.fault) : "Gravity needs three numbers.";
    wrong.textContent = fault ?? "";
    if (fault !== null) return null;
    const { couplings } = coupled;
    return { name: name.value, convention: "modified-dh", joints: rows.map(jointOf), gravity: down, couplings };
  }

  function finish() {
    const description = describe();
    if (description === null) return;
    finished(description, (pointer) => {
      const cell = [...body.querySelectorAll("[data-pointer]")].find(
        (one) => pointer && (one.dataset.pointer === pointer || one.dataset.pointer.startsWith(`${pointer}/`)),
      );
      cell?.setAttribute("aria-invalid", "true");
      cell?.focus();
    });
  }

  function add() {
    rows.push({ ...EMPTY });
    show();
    body.lastElementChild.querySelector("input").focus();
  }

  function remove(index) {
    rows = without(rows, index);
    show();
  }

  async function startFrom(id) {
    if (!id) return;
    fill(note);
    try {
      const { description } = await get(`/v1/robots/${encodeURIComponent(id)}`);
      if (description.convention !== "modified-dh") {
        fill(note, `${description.name} is described by frames, not by a DH table.`);
        return;
      }
      take(description);
    } catch (error) {
      showError(note, error);
    }
  }

  function take(description) {
    if (description.prior) fill(note, "The prior is not copied: set it with the API.");
    motors.use(description.couplings ?? []);
    motorsPart.open = Boolean(description.couplings?.length);
    rows = rowsOf(description);
    gravity.value = description.gravity.map((value) => Number(value.toPrecision(7))).join(", ");
    name.value = `${description.name} copy`;
    show();
  }
}
