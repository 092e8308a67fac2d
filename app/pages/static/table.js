// The form for a modified Denavit-Hartenberg table: one row per joint, in the units of the data sheet, drawn while it is typed.
import { get } from "./api.js";
import { field, freshId, menu, readNumber, segments } from "./controls.js";
import { element, fill } from "./dom.js";

const ANGLES = { deg: Math.PI / 180, rad: 1 };
const LENGTHS = { mm: 1e-3, m: 1 };
const COLUMNS = [
  { name: "alpha", kind: "angle", hint: "about x, from the z axis before" },
  { name: "d", kind: "length", hint: "along x (Craig's a)" },
  { name: "theta_offset", label: "theta", kind: "angle", hint: "about z, at zero" },
  { name: "r", kind: "length", hint: "along z (Craig's d)" },
  { name: "low", label: "lowest q", kind: "own", optional: true },
  { name: "high", label: "highest q", kind: "own", optional: true },
  { name: "gamma", kind: "angle", optional: true, more: true, hint: "branches: about the z before" },
  { name: "b", kind: "length", optional: true, more: true, hint: "branches: along the z before" },
  { name: "velocity", label: "speed limit", kind: "ownspeed", optional: true, more: true },
  { name: "torque", label: "torque limit", kind: "effort", optional: true, more: true },
  { name: "torque_constant", label: "torque constant", kind: "constant", optional: true, more: true },
  { name: "gear_ratio", label: "gear ratio", kind: "plain", optional: true, more: true },
];
const FRICTION = ["viscous", "coulomb", "offset"];
const EMPTY = { type: "revolute", alpha: 0, d: 0, theta_offset: 0, r: 0 };

/**
 * Show the form.
 * @param {HTMLElement} container
 * @param {Object} options `known`: robots to start from; `changed(description)` hears of every change that can be drawn;
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
  const wrong = element("p", { class: "hint wrong", role: "status" });
  const starts = [["", "three joints of no robot"], ...known.map((robot) => [robot.id, robot.name])];

  fill(
    container,
    element(
      "div",
      { class: "fields" },
      field("Name", name),
      field("Gravity, m/s²", gravity, "x, y, z in the base frame; points down on a level base"),
      field("Start from", menu(starts, "", startFrom)),
    ),
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
      "Khalil's letters: ",
      element("strong", {}, "d"),
      " is the distance along x, which Craig calls a; ",
      element("strong", {}, "r"),
      " is the distance along z, which Craig calls d. A turning joint adds its angle to theta, a sliding one its stroke to r.",
    ),
    element(
      "div",
      { class: "wide", tabindex: "0", role: "group", "aria-label": "Table of the joints" },
      element("table", { class: "mdh" }, head, body),
    ),
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
        ["joint", "type", "on joint"].map((label) => element("th", { scope: "col" }, label)),
        columns.map((column) =>
          element(
            "th",
            { scope: "col" },
            `${column.label ?? column.name}`,
            " ",
            element("span", { class: "unit" }, unitOf(column)),
            column.hint ? element("span", { class: "colhint" }, column.hint) : null,
          ),
        ),
        element("th", { scope: "col" }, element("span", { class: "unseen" }, "Remove")),
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
            ["revolute", "turns"],
            ["prismatic", "slides"],
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
          { "aria-label": `Joint ${index + 1} sits on` },
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
    const factor = factorOf(column, row);
    const value = row[column.name];
    const input = element("input", {
      type: "text",
      inputmode: "decimal",
      class: "figure-input",
      id: freshId("cell"),
      "data-pointer": pointerOf(index, column),
      value:
        value === undefined ? "" : typeof value === "string" ? value : String(Number((value / factor).toPrecision(10))),
      "aria-label": `Joint ${index + 1}: ${column.label ?? column.name}, ${unitOf(column, row)}`,
      on: {
        input: () => {
          const read = readNumber(input.value);
          const empty = column.optional && input.value.trim() === "";
          row[column.name] = empty ? undefined : Number.isFinite(read) ? read * factor : input.value;
          input.toggleAttribute("aria-invalid", !empty && !Number.isFinite(read));
          tell();
        },
      },
    });
    return input;
  }

  function tell() {
    const description = describe();
    if (description !== null) changed(description);
  }

  function describe() {
    const down = gravity.value
      .split(/[,;\s]+/)
      .filter(Boolean)
      .map(readNumber);
    const typed = rows
      .flatMap((row) => COLUMNS.map((column) => row[column.name]))
      .filter((value) => typeof value === "string");
    if (typed.length || down.length !== 3 || !down.every(Number.isFinite)) {
      wrong.textContent = typed.length ? `“${typed[0]}” is no number.` : "Gravity is three numbers.";
      return null;
    }
    wrong.textContent = "";
    return { name: name.value, convention: "modified-dh", joints: rows.map(joint), gravity: down };
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
    rows = rows
      .filter((_, at) => at !== index)
      .map((row) => ({ ...row, antecedent: moved(row.antecedent, index + 1) }));
    show();
  }

  async function startFrom(id) {
    if (!id) return;
    const { description } = await get(`/v1/robots/${encodeURIComponent(id)}`);
    if (description.convention !== "modified-dh") {
      wrong.textContent = `${description.name} is described by frames, not by a table.`;
      return;
    }
    rows = description.joints.map((one) => ({
      ...one,
      low: one.limits?.position?.[0],
      high: one.limits?.position?.[1],
      velocity: one.limits?.velocity ?? undefined,
      torque: one.limits?.torque ?? undefined,
      torque_constant: one.torque_constant ?? undefined,
      gear_ratio: one.gear_ratio ?? undefined,
    }));
    gravity.value = description.gravity.join(", ");
    name.value = `${description.name} copy`;
    show();
  }

  function unitOf(column, row = null) {
    const turning = row === null ? rows.some((one) => one.type === "revolute") : row.type === "revolute";
    const sliding = row === null ? rows.some((one) => one.type === "prismatic") : !turning;
    const own = [turning ? units.angle : null, sliding ? units.length : null].filter(Boolean);
    const effort = [turning ? "N m" : null, sliding ? "N" : null].filter(Boolean).join(" or ");
    return {
      angle: units.angle,
      length: units.length,
      own: own.join(" or "),
      ownspeed: own.map((unit) => `${unit}/s`).join(" or "),
      effort,
      constant: "N m/A",
      plain: "",
    }[column.kind];
  }

  function factorOf(column, row) {
    const own = row.type === "revolute" ? ANGLES[units.angle] : LENGTHS[units.length];
    return {
      angle: ANGLES[units.angle],
      length: LENGTHS[units.length],
      own,
      ownspeed: own,
      effort: 1,
      constant: 1,
      plain: 1,
    }[column.kind];
  }
}

function joint(row, index) {
  const position = row.low !== undefined && row.high !== undefined ? [row.low, row.high] : null;
  return {
    name: row.name ?? `joint_${index + 1}`,
    type: row.type,
    antecedent: row.antecedent ?? index,
    alpha: row.alpha,
    d: row.d,
    r: row.r,
    theta_offset: row.theta_offset,
    gamma: row.gamma ?? 0,
    b: row.b ?? 0,
    limits: { position, velocity: row.velocity ?? null, torque: row.torque ?? null },
    rotor_inertia: row.rotor_inertia ?? true,
    friction: row.friction ?? FRICTION,
    torque_constant: row.torque_constant ?? null,
    gear_ratio: row.gear_ratio ?? null,
  };
}

function pointerOf(index, column) {
  const place =
    { low: "limits/position", high: "limits/position", velocity: "limits/velocity", torque: "limits/torque" }[
      column.name
    ] ?? column.name;
  return `/joints/${index}/${place}`;
}

function moved(antecedent, removed) {
  if (antecedent === undefined || antecedent < removed) return antecedent;
  return antecedent - 1;
}
