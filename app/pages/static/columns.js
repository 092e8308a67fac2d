// The columns of a log: which a file has, what their names make them likely to be, and the units they may have.

export const CHANNELS = ["time", "position", "velocity", "torque", "current", "temperature"];
export const UNITS = {
  time: ["s", "ms", "us", "ns"],
  position: ["rad", "deg", "m", "mm", "counts"],
  velocity: ["rad/s", "deg/s", "rpm", "m/s", "mm/s"],
  torque: ["N m", "mN m", "N", "counts"],
  current: ["A", "mA"],
  temperature: ["degC", "K"],
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

/** Guess by names what columns are; at most one is time. A unit is never guessed. */
export function likelyRoles(columns) {
  const roles = columns.map((name) => (LIKELY.find(([, pattern]) => pattern.test(name)) ?? [""])[0]);
  const time = roles.indexOf("time");
  return roles.map((role, index) => (role === "time" && index !== time ? "" : role));
}

/** List a channel's units for a menu in which none is chosen yet. */
export function unitChoices(channel) {
  return [["", "choose"], ...UNITS[channel].map((unit) => [unit, unit])];
}

/** Say in which unit a count of a channel's converter is given. */
export function oneCount(channel) {
  return channel === "position" ? "in rad or m" : "in N m or N";
}
