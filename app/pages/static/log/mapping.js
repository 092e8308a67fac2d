// The form that maps columns to channels, joints and units. It fills in channels by names, and never a unit; the mapping
// that the service suggests stands above it, with units, and is applied by a click only.
import { CHANNELS, likelyRoles, knownUnits, oneCount, unitChoices } from "./columns.js";
import { field, figure, menu, readNumber } from "../base/controls.js";
import { element, fill } from "../base/dom.js";

const EACH = "each";
const NEEDS_SCALE = new Set(["counts", "%"]);
const OF_A_MOTOR = "one number, or one per joint with blanks between; of a motor's angle or speed 1/(gear ratio), of its torque the gear ratio";
const PROFILES = {
  "ur-rtde": "Universal Robots, RTDE",
  franka: "Franka, libfranka",
  "ros-jointstate": "ROS, JointState",
  rostopic: "ROS, rostopic echo -p",
  lerobot: "LeRobot",
  "kuka-fri": "KUKA, FRI (pyfri)",
  "kinova-kortex": "Kinova, Kortex",
  "abb-test-signal-viewer": "ABB, Test Signal Viewer",
};
const DRIVE_GAIN =
  "Joint torque is motor current times the drive gain: torque constant (N m/A) times gear ratio. Enter both for each joint in the robot's table, under “more columns”. If torque is logged as well, torque is used.";

/** Tell whether a suggested mapping leaves nothing open. */
function isWhole(mapping) {
  return !JSON.stringify(mapping).includes('"?"');
}

/** Give the number of one joint out of one for all, or one for each with blanks between. */
function nth(text, index, count) {
  const parts = text.trim().split(/[;\s]+/);
  if (parts.length === 1) return parts[0];
  return parts.length === count ? parts[index].replace(/,$/, "") : "";
}

/** Give each column the channel that a mapping has it for. */
function rolesIn(mapping, columns) {
  const channels = new Map(
    Object.entries(mapping).flatMap(([channel, request]) =>
      (request?.columns ?? [request?.column]).map((name) => [name, channel]),
    ),
  );
  return columns.map((name) => channels.get(name) ?? "");
}

/** Give each column the joint, from 1, that a mapping has it for. */
function jointsIn(mapping, columns) {
  const joints = new Map(
    Object.values(mapping).flatMap((request) => (request?.columns ?? []).map((name, index) => [name, index + 1])),
  );
  return columns.map((name) => joints.get(name) ?? null);
}

/**
 * Give a suggested mapping the units that a robot's joints have.
 * @param {Object} mapping as for revolute joints
 * @param {Object} sliding as for prismatic joints
 * @param {Object?} robot null where none was chosen
 */
function ofRobot(mapping, sliding, robot) {
  const types = robot?.description.joints.filter((joint) => !joint.mimics).map((joint) => joint.type) ?? [];
  if (!types.includes("prismatic")) return mapping;
  const requests = Object.entries(mapping).map(([channel, request]) => {
    if (request?.columns?.length !== types.length || !request.unit) return [channel, request];
    const other = sliding[channel];
    const units = types.map((type, index) => unitAt(type === "prismatic" ? other : request, index));
    const scale = request.scale ?? other.scale;
    const unit = new Set(units).size > 1 ? units : units[0];
    return [channel, { ...request, unit, ...(scale === undefined ? {} : { scale }) }];
  });
  return Object.fromEntries(requests);
}

/** Give the unit of one joint out of one for all, or one for each. */
function unitAt(request, index) {
  return Array.isArray(request.unit) ? request.unit[index] : request.unit;
}

/** Show a mapping that the names of the columns suggest, to be confirmed. */
function suggestion(mapping, finished) {
  const rows = Object.entries(mapping).map(([channel, request]) => [
    channel,
    request?.columns?.join(", ") ?? request?.column ?? String(request),
    [request?.unit ?? ""].flat().join(", "),
  ]);
  const confirm = element(
    "button",
    { type: "button", class: "primary", on: { click: () => finished(mapping) } },
    "Apply suggested mapping",
  );
  const open = element("p", { class: "hint" }, "The factors are in no log: choose the units and enter the factors below.");
  return element(
    "div",
    { class: "suggestion", role: "group", "aria-label": "Suggested mapping" },
    element("p", {}, "The names and sizes of the columns suggest, in this order of the joints:"),
    element(
      "table",
      {},
      element(
        "thead",
        {},
        element("tr", {}, ["channel", "columns", "unit"].map((name) => element("th", { scope: "col" }, name))),
      ),
      element(
        "tbody",
        {},
        rows.map(([channel, ...cells]) =>
          element("tr", {}, element("th", { scope: "row" }, channel), cells.map((cell) => element("td", {}, cell))),
        ),
      ),
    ),
    element("div", { class: "actions" }, isWhole(mapping) ? confirm : open),
  );
}

/**
 * Show the form.
 * @param {HTMLElement} container
 * @param {Object} options `columns` of the file; `readings`: what units are plausible by column; `suggested` mappings, and `sliding`: the
 *   same for prismatic joints; `robot` that was chosen, if any; `finished(mapping)`
 * @returns {{use: function(Object): void}} to be told the robot
 */
export function mappingForm(container, { columns, readings, suggested = [], sliding = [], robot = null, finished }) {
  const told = rolesIn(suggested[0] ?? {}, columns);
  const roles = told.some(Boolean) ? told : likelyRoles(columns);
  const joints = jointsIn(suggested[0] ?? {}, columns);
  const units = {};
  const scales = {};
  const unitsOf = columns.map(() => "");
  const scalesOf = columns.map(() => "");
  let rate = "";
  const head = element("tr", {});
  const body = element("tbody", {});
  const declared = element("div", { class: "fields" });
  const wrong = element("p", { class: "hint wrong", role: "status" });
  const suggestions = element("div", {});
  fill(
    container,
    element(
      "section",
      { class: "mapping", "aria-label": "Mapping of columns" },
      element("h3", {}, "Map columns"),
      suggestions,
      field(
        "Recorder profile",
        menu([["", "none: map the columns below"], ...Object.entries(PROFILES)], "", (profile) => {
          if (profile) finished({ profile });
        }),
        "defines the columns and most of the units",
      ),
      element(
        "div",
        { class: "wide tall", tabindex: "0", role: "group", "aria-label": "Columns of the file" },
        element(
          "table",
          {},
          element("thead", {}, head),
          body,
        ),
      ),
      declared,
      element(
        "div",
        { class: "actions" },
        element("button", { type: "button", class: "primary", on: { click: finish } }, "Apply mapping"),
        wrong,
      ),
    ),
  );
  use(robot);
  show();
  return { use };

  function use(chosen) {
    fill(suggestions, suggested.map((mapping, index) => suggestion(ofRobot(mapping, sliding[index], chosen), finished)));
  }

  function show() {
    const focused = document.activeElement?.name;
    number();
    const anyOfItsOwn = columns.some((_, index) => ofItsOwn(index));
    fill(
      head,
      ["column", "channel", "joint", ...(anyOfItsOwn ? ["unit"] : [])].map((name) =>
        element("th", { scope: "col" }, name),
      ),
    );
    fill(
      body,
      columns.map((name, index) =>
        element(
          "tr",
          {},
          element("th", { scope: "row" }, name),
          element(
            "td",
            {},
            menu(
              [["", "not used"], ...CHANNELS.map((channel) => [channel, channel])],
              roles[index],
              (role) => {
                roles[index] = role;
                joints[index] = null;
                unitsOf[index] = "";
                scalesOf[index] = "";
                show();
              },
              { "aria-label": `Channel of ${name}`, name: `role-${index}` },
            ),
          ),
          element(
            "td",
            {},
            roles[index] && roles[index] !== "time"
              ? element("input", {
                  type: "number",
                  min: 1,
                  max: 64,
                  value: joints[index],
                  "aria-label": `Joint of ${name}`,
                  on: {
                    change: (event) => {
                      joints[index] = event.target.valueAsNumber;
                    },
                  },
                })
              : null,
          ),
          anyOfItsOwn ? element("td", {}, ofItsOwn(index) ? ownUnit(index) : null) : null,
        ),
      ),
    );
    const used = CHANNELS.filter((channel) => roles.includes(channel));
    fill(
      declared,
      used.map(unitField),
      roles.includes("time")
        ? null
        : field(
            "Rate, Hz",
            figure(rate, (text) => {
              rate = text;
            }),
            "uniform sampling, if no column is time",
          ),
    );
    if (focused) container.querySelector(`[name="${focused}"]`)?.focus();
  }

  function unitField(channel) {
    const hints = [
      ...new Set(columns.filter((_, index) => roles[index] === channel).flatMap((name) => readings[name] ?? [])),
    ].filter((hint) => knownUnits(channel).includes(hint.split(":")[0]));
    const differ = channel === "time" ? [] : [[EACH, "differs by joint"]];
    const list = menu(
      [...unitChoices(channel), ...differ],
      units[channel] ?? "",
      (unit) => {
        units[channel] = unit;
        wrong.textContent = "";
        show();
      },
      { name: `unit-of-${channel}` },
    );
    const made = [
      field(`Unit of ${channel}`, list, hints.length ? `plausible: ${hints.slice(0, 2).join("; ")}` : null),
      channel === "current" ? element("p", { class: "hint" }, DRIVE_GAIN) : null,
    ];
    if (units[channel] === "counts") made.push(scaleField(channel, `One count of ${channel}`, oneCount(channel)));
    else if (units[channel] === "%") made.push(scaleField(channel, `One % of ${channel}`, oneCount(channel)));
    else if (leftOpen(channel)) made.push(scaleField(channel, `Factor on ${channel}`, OF_A_MOTOR));
    return made;
  }

  function scaleField(channel, label, hint) {
    return field(
      label,
      figure(scales[channel], (text) => {
        scales[channel] = text;
      }),
      hint,
    );
  }

  /** Tell whether the suggestion leaves a channel's factor to the user: what is named after a motor lies before a gear. */
  function leftOpen(channel) {
    return suggested.some((mapping) => mapping[channel]?.scale === "?") && units[channel] !== EACH;
  }

  /** Tell whether a column of a channel has to be multiplied by what the user enters. */
  function isScaled(channel, unit) {
    return NEEDS_SCALE.has(unit) || leftOpen(channel);
  }

  /** Tell whether a column has a unit of its own, because the joints of its channel differ. */
  function ofItsOwn(index) {
    return Boolean(roles[index]) && units[roles[index]] === EACH;
  }

  function ownUnit(index) {
    const name = columns[index];
    const list = menu(
      unitChoices(roles[index]),
      unitsOf[index],
      (unit) => {
        unitsOf[index] = unit;
        wrong.textContent = "";
        show();
      },
      { "aria-label": `Unit of ${name}`, name: `unit-${index}` },
    );
    if (!NEEDS_SCALE.has(unitsOf[index])) return list;
    const count = figure(
      scalesOf[index],
      (text) => {
        scalesOf[index] = text;
      },
      {
        "aria-label": `One ${unitsOf[index] === "%" ? "%" : "count"} of ${name}, ${oneCount(roles[index])}`,
        placeholder: oneCount(roles[index]),
      },
    );
    return [list, count];
  }

  /** Number the joints of each channel by the order of their columns, where nothing else was said. */
  function number() {
    for (const channel of CHANNELS) {
      let next = 0;
      roles.forEach((role, index) => {
        if (role !== channel) return;
        next += 1;
        joints[index] ??= next;
      });
    }
  }

  function finish() {
    const mapping = {};
    for (const channel of CHANNELS) {
      const own = columns
        .map((name, index) => ({
          name,
          joint: joints[index],
          role: roles[index],
          unit: ofItsOwn(index) ? unitsOf[index] : units[roles[index]],
          count: ofItsOwn(index) ? scalesOf[index] : scales[roles[index]],
        }))
        .filter((one) => one.role === channel);
      if (!own.length) continue;
      const unsaid = own.find((one) => !one.unit);
      if (unsaid) {
        const which = units[channel] === EACH ? unsaid.name : channel;
        wrong.textContent = `Choose the unit of ${which}: units are never guessed.`;
        return;
      }
      if (channel === "time" && own.length > 1) {
        wrong.textContent = "Choose one column as time.";
        return;
      }
      if (channel === "time") {
        mapping.time = { column: own[0].name, unit: units.time };
        continue;
      }
      own.sort((a, b) => a.joint - b.joint);
      if (own.some((one, index) => one.joint !== index + 1)) {
        wrong.textContent = `Number the joints of ${channel} from 1 to ${own.length}, each once.`;
        return;
      }
      const each = units[channel] === EACH;
      mapping[channel] = {
        columns: own.map((one) => one.name),
        unit: each ? own.map((one) => one.unit) : units[channel],
      };
      if (own.some((one) => isScaled(channel, one.unit))) {
        const factors = own.map((one, index) =>
          isScaled(channel, one.unit) ? readNumber(each ? (one.count ?? "") : nth(one.count ?? "", index, own.length)) : 1,
        );
        const unclear = own.find((_, index) => !Number.isFinite(factors[index]));
        if (unclear) {
          const what = unclear.unit === "counts" ? "value of one count" : unclear.unit === "%" ? "value of one %" : "factor";
          wrong.textContent = `Enter the ${what} of ${each ? unclear.name : channel}.`;
          return;
        }
        mapping[channel].scale = new Set(factors).size > 1 || each ? factors : factors[0];
      }
    }
    if (!mapping.time) {
      mapping.time = null;
      mapping.rate_hz = readNumber(rate);
      if (!Number.isFinite(mapping.rate_hz)) {
        wrong.textContent = "Choose a time column, or enter the rate.";
        return;
      }
    }
    wrong.textContent = "";
    finished(mapping);
  }
}
