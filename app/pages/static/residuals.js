// What the model leaves of the torque: over time, and over what it might depend on.
import { element, fill } from "./dom.js";
import { draw } from "./plot.js";
import { forEveryLog, joints, refining } from "./torque.js";

/** Show the residual of one joint at a time, four ways. */
export async function showResiduals(container, study) {
  await forEveryLog(container, study, "Residual: filtered minus estimated torque. Shaded: held out.", async (grid, log) => {
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
    }
  });
}

function overTime(views, study, joint, log, seen) {
  const place = element("div", { class: "tile broad" });
  views.append(place);
  const shown = [["residual", study.traces.extended ? "before" : "residual", { colour: 2 }], ...(study.traces.extended ? [["residual_after", "after", { colour: 3 }]] : [])];
  const finer = refining(study, joint, log, seen, (found) => plot.replace(found.time, shown.map(([signal]) => ({ values: found.values[signal] }))));
  const plot = draw(place, {
    title: `Residual of joint ${joint}`, unit: seen.units.residual, height: 200, extent: seen.extent, zoomed: finer,
    x: { label: "time", unit: "s", values: seen.time }, marks: seen.marks,
    traces: shown.map(([signal, label, look]) => ({ label, values: seen.values[signal], ...look })),
  });
  return plot;
}
