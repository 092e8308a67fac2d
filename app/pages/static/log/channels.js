// Plot every channel and joint of a log, with defects marked and one shared cursor.
import { get } from "../base/api.js";
import { element, fill } from "../base/dom.js";
import { draw } from "../drawing/plot.js";
import { showError } from "../base/problem.js";
import { refining } from "../drawing/refine.js";
import { unitOf } from "../base/words.js";

const POINTS = 1000;
const AT_ONCE = ["position", "torque", "current"];
const HEIGHT = 130;
const WHOLE = 0.95;

/**
 * Show the channels of a log.
 * @param {HTMLElement} container
 * @param {Object} log its summary
 * @returns {{use: function(Object): void, destroy: function(): void}} to be told the robot, which gives the types of the joints
 */
export function showChannels(container, log) {
  let traces = null;
  let robot = null;
  let plots = [];
  let finer = () => {};
  fill(container, element("p", { class: "waiting", role: "status" }, "Drawing the channels …"));
  load();
  return {
    use(known) {
      robot = known;
      if (traces !== null) show();
    },
    destroy: clear,
  };

  async function load() {
    try {
      traces = await read({});
      show();
    } catch (error) {
      showError(container, error);
    }
  }

  function read(stretch) {
    const query = new URLSearchParams({ points: POINTS, ...stretch });
    return get(`/v1/logs/${encodeURIComponent(log.id)}/traces?${query}`);
  }

  function clear() {
    for (const { plot } of plots) plot.destroy();
    plots = [];
  }

  function show() {
    clear();
    const start = traces.time.values[0];
    const extent = [0, traces.time.values.at(-1) - start];
    const x = { label: "time", unit: "s", values: traces.time.values.map((stamp) => stamp - start) };
    finer = refining(
      { ...traces, whole: traces.rows_per_stretch === 1, extent },
      ([from, to]) => read({ from: start + from, to: start + to }),
      (found) => {
        const time = found.time.values.map((stamp) => stamp - start);
        for (const { plot, place } of plots) plot.replace(time, [{ values: found.traces[place].values }]);
      },
    );
    const decimation =
      traces.rows_per_stretch > 1 ? `Min/max decimation over ${traces.rows_per_stretch} samples.` : "";
    fill(
      container,
      element(
        "p",
        { class: "hint" },
        `Check that every plot shows the expected motion. Drag over a plot to zoom; Escape shows the whole range. ${decimation}`,
      ),
      log.channels.map((channel) => group(channel, { x, extent, start })),
    );
  }

  function group(channel, { x, extent, start }) {
    const grid = element("div", { class: "plots" });
    const own = traces.traces.filter((trace) => trace.channel === channel);
    const open = AT_ONCE.includes(channel);
    const box = element("details", { class: "channel", open }, element("summary", {}, capital(channel)), grid);
    const drawAll = () =>
      own.forEach((trace) => {
        const place = element("div", {});
        grid.append(place);
        const plot = draw(place, {
          title: `${capital(channel)} of joint ${trace.joint}`,
          unit: unitOf(trace, robot?.description.joints.filter((one) => !one.mimics)[trace.joint - 1]?.type).replace(/^1$/, ""),
          x,
          extent,
          traces: [{ label: channel, values: trace.values, colour: channel.startsWith("position") ? 1 : 2 }],
          height: HEIGHT,
          together: log.id,
          marks: marksOf(channel, trace.joint, start),
          zoomed: (from, to) => finer(from, to),
        });
        plots.push({ plot, place: traces.traces.indexOf(trace) });
      });
    if (open)
      requestAnimationFrame(drawAll); // once the grid has its width
    else box.addEventListener("toggle", drawAll, { once: true });
    return box;
  }

  function marksOf(channel, joint, start) {
    return log.defects
      .filter(
        (defect) => (defect.channel === channel && (defect.joint ?? joint) === joint) || defect.channel === "time",
      )
      .flatMap((defect) =>
        defect.intervals.map(([from, to]) => ({ from: from - start, to: to - start, label: defect.kind })),
      )
      .filter((mark) => mark.to - mark.from < WHOLE * log.duration_s); // what concerns all of the log has no place in it
  }
}

function capital(text) {
  return (text.charAt(0).toUpperCase() + text.slice(1)).replace("_ref", " reference");
}
