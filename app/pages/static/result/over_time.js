// Draw base parameters over time, as a Kalman filter follows them whose parameters drift.
import { element, fill } from "../base/dom.js";
import { draw } from "../drawing/plot.js";

const INTERVAL = 1.959964;

/** Give the figure of one parameter at a time, the one that changes most to begin with; null where none was followed. */
export function overTime(document) {
  const track = document.estimation?.over_time;
  if (!track) return null;
  const rows = document.base_parameters;
  const place = element("div", { class: "tile broad" });
  const choice = element("select", { id: "followed", on: { change: show } },
    rows.map((row, index) => element("option", { value: index }, row.name)));
  choice.value = String(largest(rows.map((_, index) => change(track, index))));
  let plot = null;
  queueMicrotask(show); // the place has a width once it is in the page
  return element("div", {},
    element("h3", {}, "Over time"),
    element("p", { class: "hint" }, "The filter lets parameters drift and follows them. Dashed: 95 % interval."),
    element("p", { class: "row" }, element("label", { for: "followed" }, "Parameter"), choice), place);

  function show() {
    const index = Number(choice.value);
    const value = track.value.map((row) => row[index]);
    const half = track.standard_deviation.map((row) => INTERVAL * row[index]);
    plot?.destroy();
    fill(place);
    plot = draw(place, {
      title: rows[index].name, unit: rows[index].unit, height: 220, x: { label: "time", unit: "s", values: clock(track) },
      traces: [
        { label: "value", values: value, colour: 1 },
        { label: "95 % interval", values: value.map((one, at) => one - half[at]), colour: 1, dashed: true },
        { label: "upper end", values: value.map((one, at) => one + half[at]), colour: 1, dashed: true, unnamed: true },
      ],
    });
  }
}

// How far a parameter moves, in its deviations.
function change(track, index) {
  const value = track.value.map((row) => row[index]);
  const deviation = Math.max(...track.standard_deviation.map((row) => row[index]));
  return deviation > 0 ? (Math.max(...value) - Math.min(...value)) / deviation : 0;
}

function largest(values) {
  return values.indexOf(Math.max(...values));
}

// Time of all logs, one after the other: each begins where the one before ends.
function clock(track) {
  let offset = 0;
  return track.time.map((time, at) => {
    if (at && track.log[at] !== track.log[at - 1]) offset += track.time[at - 1];
    return offset + time;
  });
}
