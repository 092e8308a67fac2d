// The columns of a log file: their names, likely channels, and possible units.

const TABLE = JSON.parse(document.querySelector("meta[name=channels]").content);
export const CHANNELS = Object.keys(TABLE.channels);
const REFERENCE_WORDS = new Set(TABLE.reference_words);
const BY_TRUST = [...CHANNELS.filter((channel) => channel !== "position"), "position"]; // "joint" says least
const NO_CHANNEL = /acc|^qdd|^ddq/i;
const LONG = 3;
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
  const roles = columns.map(likelyRole);
  const time = roles.indexOf("time");
  return roles.map((role, index) => (role === "time" && index !== time ? "" : role));
}

function likelyRole(name) {
  if (NO_CHANNEL.test(name)) return "";
  const words = (name.match(/[A-Z]+(?![a-z])|[A-Z]?[a-z]+/g) ?? []).map((word) => word.toLowerCase());
  const told = (known) => words.some((word) => word === known || (known.length >= LONG && word.includes(known)));
  const own = BY_TRUST.filter((channel) => TABLE.channels[channel].words.some(told));
  const measured = own.find((channel) => channel !== "command");
  if (!measured || !words.some((word) => REFERENCE_WORDS.has(word))) return measured ?? own[0] ?? "";
  return CHANNELS.find((channel) => TABLE.channels[channel].reference_to === measured) ?? "";
}

/** List a channel's units for a menu in which none is chosen yet. */
export function unitChoices(channel) {
  return [["", "choose"], ...knownUnits(channel).map((unit) => [unit, unit])];
}

/** Name the units that a channel may have. */
export function knownUnits(channel) {
  return TABLE.channels[channel].units;
}

/** Say in which unit a count of a channel's converter is given. */
export function oneCount(channel) {
  return `in ${TABLE.channels[channel].unit}`;
}
