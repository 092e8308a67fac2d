// Measured, filtered and estimated torque of every joint, and the motion they belong to, drawn again finer when zoomed.
import { element, fill } from "../base/dom.js";
import { draw } from "../drawing/plot.js";
import { refining } from "../drawing/refine.js";
import { relative } from "../base/words.js";

/** Show torque, joint by joint. */
export async function showTorque(container, study) {
  const hint = `Shaded: held-out data. Drag to zoom all plots; Escape or “Whole range” shows the whole range.`;
  await forEveryLog(container, study, hint, async (grid, log) => {
    const plots = await Promise.all(joints(study).map(async (joint) => {
      const place = element("div", { class: "tile" });
      grid.append(place);
      return torquePlot(place, study, joint, log);
    }));
    return () => plots.forEach((plot) => plot.destroy());
  });
}

/** Show the motion that excited the parameters: positions and speeds of all joints. */
export async function showMotion(container, study) {
  await forEveryLog(container, study, "", async (grid, log) => {
    const seen = await Promise.all(joints(study).map((joint) => study.traces.of(joint, log)));
    const plots = [["position", "Position"], ["velocity", "Speed"]].flatMap(([signal, title]) => [...new Set(seen.map((one) => one.units[signal]))].map((unit) => {
      const place = element("div", { class: "tile broad" });
      grid.append(place);
      const own = seen.map((one, index) => [one, index + 1]).filter(([one]) => one.units[signal] === unit);
      return draw(place, {
        title, unit, height: 220, together: "motion", x: { label: "time", unit: "s", values: own[0][0].time },
        traces: own.map(([one, joint]) => ({ label: `joint ${joint}`, values: one.values[signal], colour: joint })),
        marks: own[0][0].marks,
      });
    }));
    return () => plots.forEach((plot) => plot.destroy());
  });
}

/** The joints of a study, counted from 1. */
export function joints(study) {
  return Array.from({ length: study.traces.joints }, (_, index) => index + 1);
}

/** Let a reader choose among the logs, and draw the chosen one; `drawn` gives what takes the drawing away again. */
export async function forEveryLog(container, study, hint, drawn) {
  const grid = element("div", { class: "tiles" });
  const names = study.document.logs.map((log, index) => `${index + 1}. ${log.name}`);
  const choice = names.length > 1 ? element("select", { "aria-label": "Log", on: { change: () => show(choice.selectedIndex + 1) } }, names.map((name) => element("option", {}, name))) : null;
  fill(container, element("div", { class: "row" }, choice, hint ? element("p", { class: "hint" }, hint) : null), grid);
  let clear = () => {};
  await show(1);

  async function show(log) {
    clear();
    fill(grid);
    clear = await drawn(grid, log);
  }
}

async function torquePlot(place, study, joint, log) {
  const seen = await study.traces.of(joint, log);
  const shown = [
    ["torque_measured", "measured", { colour: 7, width: 1 }],
    ["torque_filtered", "filtered", { colour: 1, width: 2.2 }],
    ["torque_estimated", study.traces.extended ? "model before" : "estimated", { colour: 2, width: 1.8, dashed: true }],
    ...(study.traces.extended ? [["torque_estimated_after", "model after", { colour: 3, width: 1.8, dashed: true }]] : []),
  ];
  const score = (study.document.validation.length ? study.document.validation : study.document.fit)[joint - 1];
  const raw = { found: null };
  const tracesOf = (found) => shown.map(([signal, label, look]) => ({
    label, ...look, values: found.values[signal], ...(signal === "torque_measured" && raw.found ? raw.found : {}),
  }));
  let now = seen;
  const show = (found) => {
    now = found;
    plot.replace(found.time, tracesOf(found));
  };
  const finer = refining(seen, (range) => study.traces.of(joint, log, range), show);
  let finerRaw = () => {};
  const plot = draw(place, {
    title: `Joint ${joint}`, unit: seen.units.torque_filtered, height: 190, together: `torque ${log}`, extent: seen.extent,
    x: { label: "time", unit: "s", values: seen.time }, marks: seen.marks, zoomed: (from, to) => { finer(from, to); finerRaw(from, to); },
    traces: tracesOf(seen),
    note: score.nrmse_of_rms_percent === null ? "The joint does not move: there is no error of it." : `The error ${study.document.validation.length ? "on the held-out data (shaded)" : "on the fitted data"} is ${relative(score.nrmse_of_rms_percent)} of the torque RMS.`,
  });
  study.traces.raw(joint, log).then((found) => {
    if (found === null || !place.isConnected) return;
    const showRaw = (own) => {
      raw.found = own;
      show(now);
    };
    finerRaw = refining({ ...found, extent: seen.extent }, (range) => study.traces.raw(joint, log, range), showRaw);
    showRaw(found);
  });
  return plot;
}
