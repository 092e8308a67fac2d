// Plot the residual over time, over coordinates and over frequency.
import { get } from "../base/api.js";
import { element, fill } from "../base/dom.js";
import { draw } from "../drawing/plot.js";
import { refining } from "../drawing/refine.js";
import { plain } from "../base/words.js";
import { forEveryLog, joints } from "./torque.js";

/** Show the residual of one joint at a time, four ways. */
export async function showResiduals(container, study) {
  await forEveryLog(container, study, "Residual: filtered minus estimated torque. Shaded: held-out data.", async (grid, log) => {
    let plots = [];
    const views = element("div", { class: "tiles wide-tiles" });
    const buttons = joints(study).map((joint) => element("button", { type: "button", class: "tiny", "aria-pressed": "false", on: { click: () => show(joint) } }, `Joint ${joint}`));
    grid.append(element("div", { class: "segments", role: "group", "aria-label": "Joint" }, buttons), views);
    await show(1);
    return () => plots.forEach((plot) => plot.destroy());

    async function show(joint) {
      buttons.forEach((button, index) => button.setAttribute("aria-pressed", String(index + 1 === joint)));
      plots.forEach((plot) => plot.destroy());
      fill(views);
      const seen = await study.traces.of(joint, log);
      plots = [overTime(views, study, joint, log, seen)];
      const found = await get(`${study.job.links.self}/residuals?joint=${joint}&log=${log}`);
      if (buttons[joint - 1].getAttribute("aria-pressed") !== "true") return; // another one was chosen meanwhile
      plots.push(...found.over.map((over) => overCoordinate(views, joint, found, over)), overFrequency(views, joint, found));
    }
  });
}

function overTime(views, study, joint, log, seen) {
  const place = element("div", { class: "tile broad" });
  views.append(place);
  const shown = [["residual", study.traces.extended ? "before" : "residual", { colour: 2 }], ...(study.traces.extended ? [["residual_after", "after", { colour: 3 }]] : [])];
  const finer = refining(seen, (range) => study.traces.of(joint, log, range), (found) => plot.replace(found.time, shown.map(([signal]) => ({ values: found.values[signal] }))));
  const plot = draw(place, {
    title: `Residual of joint ${joint}`, unit: seen.units.residual, height: 200, extent: seen.extent, zoomed: finer,
    x: { label: "time", unit: "s", values: seen.time }, marks: seen.marks,
    traces: shown.map(([signal, label, look]) => ({ label, values: seen.values[signal], ...look })),
  });
  return plot;
}

const SIDES = { residual: { label: "residual", colour: 2 }, residual_after: { label: "after", colour: 3 } };

function overCoordinate(views, joint, found, over) {
  const place = element("div", { class: "tile" });
  views.append(place);
  const both = over.curves.length > 1;
  return draw(place, {
    title: `Joint ${joint} over ${plain(over.coordinate)}`, unit: found.unit, height: 190,
    x: { label: over.coordinate, unit: over.unit, values: over.centre },
    traces: over.curves.flatMap(({ signal, mean, low, high }) => {
      const { label, colour } = SIDES[signal];
      const name = both && signal === "residual" ? "before" : label;
      const ends = both && signal === "residual" ? [] : [
        { label: "5 % and 95 % quantiles", values: high, colour: 7, width: 1, dashed: true },
        { label: "5 % quantile", values: low, colour: 7, width: 1, dashed: true, unnamed: true },
      ];
      return [...ends, { label: `mean ${name}`, values: mean, colour, width: 2 }];
    }),
    note: `Mean, 5 % and 95 % quantiles in bins with equal counts, ${found.samples} samples.`,
  });
}

function overFrequency(views, joint, found) {
  const place = element("div", { class: "tile broad" });
  views.append(place);
  const own = found.densities.filter((one) => one.density.length);
  if (!own.length) return { destroy() {} };
  return draw(place, {
    title: `Joint ${joint} over frequency`, unit: `${found.unit}/√Hz`, height: 190,
    x: { label: "frequency", unit: "Hz", values: own[0].frequency_hz },
    traces: own.map(({ signal, density }) => ({ label: own.length > 1 && signal === "residual" ? "before" : SIDES[signal].label, values: density.map(Math.sqrt), colour: SIDES[signal].colour, width: 1.6 })),
  });
}
