// Say numbers, times and sizes as people read them.

/** A number with so many significant digits, without trailing zeros; a true minus sign. */
export function number(value, digits = 4) {
  if (value === null || value === undefined) return "–";
  if (!Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  const text =
    size !== 0 && (size < 1e-3 || size >= 1e6)
      ? value
          .toExponential(Math.max(0, digits - 1))
          .replace(/\.?0+e/, "e")
          .replace("e+", "e")
      : String(Number(value.toPrecision(digits)));
  return text.replaceAll("-", "−");
}

/**
 * An estimate with its standard deviation: the deviation to two digits, the value to the same place, and one
 * power of ten for both where they are tiny or huge.
 */
export function measured(value, deviation) {
  if (value === null || !Number.isFinite(value) || !Number.isFinite(deviation) || !(deviation > 0)) return number(value);
  const size = Math.floor(Math.log10(Math.max(Math.abs(value), deviation)));
  const last = Math.floor(Math.log10(Number(deviation.toExponential(1)))) - 1;
  const power = size < -3 || size >= 6 ? size : 0;
  const places = Math.max(0, power - last);
  const [own, spread] = [value, deviation].map((one) => (one / 10 ** power).toFixed(Math.min(places, 20)));
  const text = power ? `(${own} ± ${spread})e${power}` : `${own} ± ${spread}`;
  return text.replaceAll("-", "−");
}

/** A whole number with thin spaces between thousands. */
export function count(value) {
  return Math.round(value)
    .toString()
    .replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

/** Say whether parameters are physically consistent: true, false, or null where it is not known. */
export function consistency(feasible) {
  if (feasible === null || feasible === undefined) return "of unknown consistency";
  return feasible ? "physically consistent" : "physically inconsistent";
}

/** How many, with its noun: plural("joint", 2) is "2 joints". */
export function plural(noun, many) {
  return `${count(many)} ${noun}${many === 1 ? "" : "s"}`;
}

/** A percentage as people read it: what is tiny or huge by the bound that it lies beyond. */
export function relative(value, digits = 3) {
  if (value === null || value === undefined) return "–";
  const size = Math.abs(value);
  const sign = value < 0 ? "−" : "";
  if (size > 0 && size < 0.05) return `${sign ? ">" : "<"}\u00a0${sign}0.1\u00a0%`;
  if (size > 1000) return `${sign ? "<" : ">"}\u00a0${sign}1000\u00a0%`;
  return `${number(value, digits)}\u00a0%`;
}

/** A share as percent. */
export function percent(fraction) {
  return `${Math.round(100 * fraction)} %`;
}

/** How long something lasts: seconds below two minutes, then minutes and hours. */
export function duration(seconds) {
  if (seconds < 10) return `${number(seconds, 2)} s`;
  if (seconds < 120) return `${Math.round(seconds)} s`;
  if (seconds < 7200) return `${Math.floor(seconds / 60)} min ${Math.round(seconds % 60)} s`;
  return `${Math.floor(seconds / 3600)} h ${Math.round((seconds % 3600) / 60)} min`;
}

/** How long ago an instant was, in its largest unit. */
export function ago(instant, now = Date.now()) {
  const seconds = Math.max(0, (now - Date.parse(instant)) / 1000);
  for (const [unit, length] of [
    ["d", 86400],
    ["h", 3600],
    ["min", 60],
  ]) {
    if (seconds >= length) return `${Math.floor(seconds / length)} ${unit} ago`;
  }
  return seconds < 10 ? "just now" : `${Math.floor(seconds)} s ago`;
}

/** A size in bytes. */
export function bytes(size) {
  for (const [unit, length] of [
    ["GB", 1e9],
    ["MB", 1e6],
    ["kB", 1e3],
  ]) {
    if (size >= length) return `${number(size / length, 3)} ${unit}`;
  }
  return `${size} bytes`;
}

/** The first letters of an id, which tell it from its neighbours. */
export function short(id) {
  return id.length <= 14 ? id : `${id.slice(0, 12)}…`;
}

/** A name of the API for people: "repeated_rows" is "repeated rows". */
export function plain(name) {
  return name.replaceAll("_", " ");
}

/** The unit of a channel by the type of the joint, where the robot is known; else as in the log. */
export function unitOf(trace, type) {
  const [revolute, prismatic] = trace.unit.split(" or ");
  if (prismatic === undefined) return revolute;
  return type === "prismatic" ? prismatic : revolute;
}

/** The kinds of job and the estimators, as the service lists them with every page. */
export const ANALYSES = JSON.parse(document.querySelector("meta[name=analyses]").content);

/** What the studies of a kind are called. */
export const KINDS = Object.fromEntries(ANALYSES.kinds.map(({ name, title }) => [name, title]));
