// The form that says which column is what, and in which unit. It guesses by names what a column is, never its unit.
import { field, menu, readNumber } from "./controls.js";
import { element, fill } from "./dom.js";

const CHANNELS = ["time", "position", "velocity", "torque", "current", "temperature"];
const UNITS = {
  time: ["s", "ms", "us", "ns"],
  position: ["rad", "deg", "m", "mm", "counts"],
  velocity: ["rad/s", "deg/s", "rpm", "m/s", "mm/s"],
  torque: ["N m", "mN m", "N", "counts"],
  current: ["A", "mA"],
  temperature: ["degC", "K"],
};
const PROFILES = {
  "ur-rtde": "Universal Robots, RTDE",
  franka: "Franka, libfranka",
  "ros-jointstate": "ROS, JointState",
  lerobot: "LeRobot",
  "abb-test-signal-viewer": "ABB, Test Signal Viewer",
};
const LIKELY = [
  ["time", /^t$|time|stamp|^sec/i],
  ["temperature", /temp/i],
  ["velocity", /vel|speed|^qd|^dq|qdot/i],
  ["current", /cur|amp|^i_?[dqm]?_?\d+$/i],
  ["torque", /tau|torq|effort|moment|force/i],
  ["", /acc|^qdd|^ddq/i],
  ["position", /pos|angle|^q_?\d*$|theta|joint/i],
];
const DRIVE_GAIN =
  "A motor's current becomes torque at its joint by the drive gain: torque constant (N m/A) times gear ratio. Both belong to each joint of the robot: in its table, under “more columns”. Where torque is logged as well, torque is used.";
const HEAD_BYTES = 1 << 16;

/** Read the columns of a text file from its first line; null for other files. */
export async function columnsOf(file) {
  const head = await file.slice(0, HEAD_BYTES).text();
  if (/[\u0000-\u0008]/.test(head)) return null;
  const line = head.split(/\r?\n/).find((one) => one.trim() && !one.startsWith("#") && !one.startsWith("%"));
  if (!line) return null;
  const separator = [",", ";", "\t"].find((one) => line.includes(one)) ?? /\s+/;
  return line
    .trim()
    .split(separator)
    .map((name) => name.trim().replace(/^"(.*)"$/, "$1"));
}

/**
 * Show the form.
 * @param {HTMLElement} container
 * @param {Object} options `columns` of the file; `readings`: what units are plausible by column; `finished(mapping)`
 */
export function mappingForm(container, { columns, readings, finished }) {
  const roles = columns.map((name) => (LIKELY.find(([, pattern]) => pattern.test(name)) ?? [""])[0]);
  const time = roles.indexOf("time");
  roles.forEach((role, index) => {
    if (role === "time" && index !== time) roles[index] = "";
  });
  const joints = columns.map(() => null);
  const units = {};
  const scales = {};
  let rate = "";
  const body = element("tbody", {});
  const declared = element("div", { class: "fields" });
  const wrong = element("p", { class: "hint wrong", role: "status" });
  fill(
    container,
    element(
      "section",
      { class: "mapping", "aria-label": "Mapping of columns" },
      element("h3", {}, "Say which column is what"),
      field(
        "A recorder's names",
        menu([["", "no, I say it below"], ...Object.entries(PROFILES)], "", (profile) => {
          if (profile) finished({ profile });
        }),
        "its columns are known, and so are most of its units",
      ),
      element(
        "div",
        { class: "wide tall", tabindex: "0", role: "group", "aria-label": "Columns of the file" },
        element(
          "table",
          {},
          element(
            "thead",
            {},
            element(
              "tr",
              {},
              ["column", "is", "of joint"].map((name) => element("th", { scope: "col" }, name)),
            ),
          ),
          body,
        ),
      ),
      declared,
      element(
        "div",
        { class: "actions" },
        element("button", { type: "button", class: "primary", on: { click: finish } }, "Read the log so"),
        wrong,
      ),
    ),
  );
  show();

  function show() {
    number();
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
                show();
              },
              { "aria-label": `What ${name} is` },
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
            element("input", {
              type: "text",
              inputmode: "decimal",
              value: rate,
              on: {
                input: (event) => {
                  rate = event.target.value;
                },
              },
            }),
            "of uniform samples, where no column holds the time",
          ),
    );
  }

  function unitField(channel) {
    const hints = [
      ...new Set(columns.filter((_, index) => roles[index] === channel).flatMap((name) => readings[name] ?? [])),
    ].filter((hint) => UNITS[channel].includes(hint.split(":")[0]));
    const list = menu([["", "choose"], ...UNITS[channel].map((unit) => [unit, unit])], units[channel] ?? "", (unit) => {
      units[channel] = unit;
      wrong.textContent = "";
      show();
    });
    const made = [
      field(`Unit of ${channel}`, list, hints.length ? `plausible: ${hints.slice(0, 2).join("; ")}` : null),
      channel === "current" ? element("p", { class: "hint" }, DRIVE_GAIN) : null,
    ];
    if (units[channel] === "counts") {
      made.push(
        field(
          `One count of ${channel}`,
          element("input", {
            type: "text",
            inputmode: "decimal",
            value: scales[channel] ?? "",
            on: {
              input: (event) => {
                scales[channel] = event.target.value;
              },
            },
          }),
          channel === "position" ? "in rad or m" : "in N m or N",
        ),
      );
    }
    return made;
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
        .map((name, index) => ({ name, joint: joints[index], role: roles[index] }))
        .filter((one) => one.role === channel);
      if (!own.length) continue;
      if (!units[channel]) {
        wrong.textContent = `Choose the unit of ${channel}: a wrong guess would be a wrong robot.`;
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
      mapping[channel] = { columns: own.map((one) => one.name), unit: units[channel] };
      if (units[channel] === "counts") {
        mapping[channel].scale = readNumber(scales[channel] ?? "");
        if (!Number.isFinite(mapping[channel].scale)) {
          wrong.textContent = `Say what one count of ${channel} is.`;
          return;
        }
      }
    }
    if (!mapping.time) {
      mapping.time = null;
      mapping.rate_hz = readNumber(rate);
      if (!Number.isFinite(mapping.rate_hz)) {
        wrong.textContent = "Choose the column that is time, or give the rate.";
        return;
      }
    }
    wrong.textContent = "";
    finished(mapping);
  }
}
