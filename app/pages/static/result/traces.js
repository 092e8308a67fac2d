// Ask for what a job computed instant by instant: joint by joint, once each, and finer on zooming in.
import { get } from "../base/api.js";

const POINTS = 1200;
const RAW_POINTS = 3000;
const ALWAYS = ["position", "velocity", "torque_measured", "torque_filtered", "torque_estimated", "residual"];
const EXTENDED = ["torque_estimated_after", "residual_after"];

/**
 * @typedef {Object} JointTraces
 * @property {number[]} time s since the log's first instant
 * @property {Object<string, (number|null)[]>} values by signal
 * @property {Object<string, string>} units by signal
 * @property {[number, number]} extent of the whole log, s since its first instant
 * @property {{from: number, to: number, label: string}[]} marks what is held out
 * @property {boolean} whole whether every instant is there
 */

/**
 * Give what asks for the traces of a job.
 * @returns {{joints: number, logs: number, extended: boolean, of: function(number, number, [number, number]=): Promise<JointTraces>,
 *   raw: function(number, number, [number, number]=): Promise<{at: number[], values: number[], whole: boolean}|null>}}
 */
export function tracesOf(job, document) {
  const extended = Boolean(document.diagnosis?.after?.base_parameters?.length);
  const signals = extended ? [...ALWAYS, ...EXTENDED] : ALWAYS;
  const known = new Map();
  const starts = new Map();
  const logs = new Map();
  return { joints: document.fit?.length ?? 0, logs: document.logs.length, extended, of, raw };

  /** Read all signals of a joint of a log, both counted from 1; a range in s reads that part of it, finer. */
  function of(joint, log = 1, range = null) {
    const key = `${joint} ${log} ${range ?? ""}`;
    if (!known.has(key)) {
      const asked = read(joint, log, range);
      asked.catch(() => known.delete(key));
      known.set(key, asked);
    }
    return known.get(key);
  }

  /** The torque as it was logged, before any filter; null where the log was deleted since, or holds currents. */
  async function raw(joint, log, range = null) {
    const key = `${log} ${range ?? ""}`;
    if (!logs.has(key)) {
      const query = new URLSearchParams({ channels: "torque", points: RAW_POINTS, ...stretch(log, range) });
      const asked = get(`/v1/logs/${encodeURIComponent(job.logs[log - 1])}/traces?${query}`);
      logs.set(key, asked.catch(() => null)); // of all joints at once, because their plots zoom together
    }
    const seen = await logs.get(key);
    const own = seen?.traces.find((trace) => trace.joint === joint);
    if (!own) return null;
    return { at: seen.time.values.map((stamp) => stamp - starts.get(log)), values: own.values, whole: seen.rows_per_stretch === 1 };
  }

  // A range in s since the log's first instant, on the log's own clock as a query takes it.
  function stretch(log, range) {
    return range === null ? {} : { from: starts.get(log) + range[0], to: starts.get(log) + range[1] };
  }

  async function read(joint, log, range) {
    const query = new URLSearchParams({ joint, log, signals: signals.join(","), points: POINTS, ...stretch(log, range) });
    const seen = await get(`${job.links.self}/traces?${query}`);
    const start = seen.extent[0];
    starts.set(log, start);
    return {
      time: seen.time.values.map((stamp) => stamp - start),
      values: Object.fromEntries(seen.traces.map((trace) => [trace.signal, trace.values])),
      units: Object.fromEntries(seen.traces.map((trace) => [trace.signal, trace.unit])),
      extent: [0, seen.extent[1] - start],
      marks: seen.held_out.map(([from, to]) => ({ from: from - start, to: to - start, label: "held out", quiet: true })),
      whole: seen.rows_per_stretch === 1,
    };
  }
}
