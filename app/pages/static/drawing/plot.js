// Draw traces over one axis with uPlot, in a figure with keyboard control, a text alternative and CSV export.
import { element, fill } from "../base/dom.js";
import uPlot from "../uPlot.esm.js";
import { number } from "../base/words.js";

export const MOST_POINTS = 4000;
const COLOURS = 7;
const SMALL = 150; // px of height below which ticks carry the unit and the axis has no name
const cursors = new Map();

/**
 * @typedef {Object} TraceOfPlot
 * @property {string} label
 * @property {(number|null)[]} values null is a gap; as many as there are x values, at most MOST_POINTS
 * @property {number[]} [at] x values of its own
 * @property {number} [colour] 1 to 7, else by its place
 * @property {boolean} [dashed]
 * @property {boolean} [dots] points without a line
 * @property {number} [width]
 * @property {boolean} [unnamed] left out of the legend: another trace's entry tells of it
 */

/**
 * Draw a plot into a container.
 * @param {HTMLElement} container
 * @param {Object} plot
 * @param {string} plot.title
 * @param {string} [plot.unit] of y; "" for none
 * @param {{label: string, unit: string, values: number[]}} plot.x
 * @param {TraceOfPlot[]} plot.traces
 * @param {number} [plot.height] px
 * @param {string} [plot.together] plots of one name share cursor and zoom
 * @param {{from: number, to: number, label: string, quiet?: boolean}[]} [plot.marks] stretches of x to shade
 * @param {string} [plot.note] one more sentence for those who hear the page
 * @param {[number, number]} [plot.extent] the whole range of x, where the values are only a part of it
 * @param {function(number, number): void} [plot.zoomed] called with the range of x that is shown, at every change
 * @returns {{replace: function(number[], {values: (number|null)[], at?: number[]}[]): void, destroy: function(): void}} `replace`
 *   gives the traces other values and leaves the range that is shown
 */
export function draw(container, plot) {
  const { title, unit = "", x, traces, height = 180, together = null, marks = [], note = "", zoomed = null } = plot;
  const small = height <= SMALL;
  let data = joined(x.values, traces);
  const [first, last] = plot.extent ?? [data[0][0], data[0][data[0].length - 1]];
  const canvas = element("div", { class: "canvas", role: "img", "aria-label": summary(title, unit, traces, note) });
  const reset = element("button", { type: "button", class: "tiny", hidden: true, on: { click: () => all() } }, "Whole range");
  const save = element("button", { type: "button", class: "tiny", "aria-label": `Save ${title} as CSV` }, "CSV");
  const figure = element("figure", { class: "plot" },
    element("figcaption", {},
      element("span", { class: "title" }, title, unit ? element("span", { class: "unit" }, ` ${unit}`) : null),
      traces.length > 1 ? legend(traces) : null,
      element("span", { class: "tools" }, reset, save)),
    canvas, numbers(title, unit, traces));
  fill(container, figure);

  const made = new uPlot(options(), data, canvas);
  const group = together === null ? null : member(together, made);
  const seen = new ResizeObserver(() => {
    if (canvas.clientWidth > 0 && canvas.clientWidth !== made.width) made.setSize({ width: canvas.clientWidth, height });
  });
  seen.observe(canvas);
  const recolour = () => made.redraw(false);
  addEventListener("themechange", recolour);
  save.addEventListener("click", () => saveCsv(title, unit, x, traces, data));
  canvas.tabIndex = 0;
  canvas.addEventListener("keydown", steer);

  return {
    replace(values, others) {
      data = joined(values, others);
      made.setData(data, false);
      made.redraw();
    },
    destroy() {
      seen.disconnect();
      removeEventListener("themechange", recolour);
      group?.leave();
      made.destroy();
    },
  };

  function all() {
    zoom(first, last);
  }

  function zoom(min, max) {
    for (const one of group?.members ?? [made]) one.setScale("x", { min, max });
  }

  function steer(event) {
    const { min, max } = made.scales.x;
    const span = max - min;
    const kept = (low, wide) => {
      const from = Math.min(Math.max(low, first), Math.max(first, last - wide));
      zoom(from, Math.min(from + wide, last));
    };
    const actions = {
      "+": () => kept(min + span / 4, span / 2),
      "=": () => kept(min + span / 4, span / 2),
      "-": () => kept(min - span / 2, span * 2),
      ArrowLeft: () => kept(min - span / 4, span),
      ArrowRight: () => kept(min + span / 4, span),
      0: all,
      Escape: all,
    };
    if (!(event.key in actions) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    actions[event.key]();
  }

  function options() {
    const axis = { stroke: () => colour("--soft"), grid: { stroke: () => colour("--grid"), width: 1 }, ticks: { show: false }, font: "12px system-ui, sans-serif" };
    return {
      width: Math.max(canvas.clientWidth, 240),
      height,
      legend: { show: false },
      padding: [8, 10, 0, 0],
      scales: { x: { time: false }, y: { range: (_, low, high) => margin(low, high) } },
      cursor: {
        drag: { x: true, y: false, setScale: true },
        points: { size: 6 },
        ...(together === null ? {} : { sync: { key: together, scales: ["x", null] } }),
      },
      axes: [
        small
          ? { ...axis, size: 24, gap: 4, values: (_, splits) => splits.map((value) => `${number(value, 6)}${x.unit ? ` ${x.unit}` : ""}`) }
          : { ...axis, size: 22, gap: 4, values: (_, splits) => splits.map((value) => number(value, 6)), label: x.unit ? `${x.label}, ${x.unit}` : x.label, labelSize: 18, labelFont: axis.font, labelGap: 0 },
        { ...axis, size: 52, gap: 4, space: 26, values: (_, splits) => splits.map((value) => (value === null ? "" : number(value, 4))) },
      ],
      series: [{ label: x.label }, ...traces.map(line)],
      hooks: {
        drawClear: [shade],
        setScale: [(drawn, key) => {
          if (key !== "x") return;
          const { min, max } = drawn.scales.x;
          reset.hidden = min <= first && max >= last;
          if (group !== null) group.follow(drawn, min, max);
          zoomed?.(min, max);
        }],
      },
    };
  }

  function shade(drawn) {
    const { ctx, bbox } = drawn;
    ctx.save();
    for (const mark of marks) {
      ctx.fillStyle = colour(mark.quiet ? "--quiet-mark" : "--mark");
      const left = Math.max(drawn.valToPos(mark.from, "x", true), bbox.left);
      const right = Math.min(drawn.valToPos(mark.to, "x", true), bbox.left + bbox.width);
      if (right >= bbox.left && left <= bbox.left + bbox.width) ctx.fillRect(left, bbox.top, Math.max(right - left, 2), bbox.height);
    }
    ctx.restore();
  }
}

// Bring traces onto one axis; where one has no value of its own, its line goes on, but ends at a gap.
function joined(xs, traces) {
  const cut = (values) => values.slice(0, MOST_POINTS);
  if (traces.every((trace) => trace.at === undefined)) return [xs, ...traces.map((trace) => trace.values)].map(cut);
  return uPlot.join(traces.map((trace) => [cut(trace.at ?? xs), cut(trace.values)]));
}

/** The colour of a trace, by its number from 1. */
export function traceColour(place) {
  return colour(`--trace-${((place - 1) % COLOURS) + 1}`);
}

function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function line(trace, place) {
  const stroke = () => traceColour(trace.colour ?? place + 1);
  return {
    label: trace.label,
    stroke,
    width: trace.dots ? 0 : trace.width ?? 1.4,
    dash: trace.dashed ? [6, 4] : undefined,
    spanGaps: false,
    points: trace.dots ? { show: true, size: 4, fill: stroke, width: 0 } : { show: false },
  };
}

function margin(low, high) {
  if (low === null || high === null) return [-1, 1];
  const room = (high - low || Math.abs(high) || 1) * 0.06;
  return [low - room, high + room];
}

// Plots of one name zoom together; one that is told to follow does not tell the others again.
function member(name, made) {
  if (!cursors.has(name)) cursors.set(name, { members: new Set(), leading: false });
  const group = cursors.get(name);
  group.members.add(made);
  return {
    members: group.members,
    follow(leader, min, max) {
      if (group.leading) return;
      group.leading = true;
      for (const one of group.members) {
        const same = one.scales.x.min === min && one.scales.x.max === max;
        if (one !== leader && !same) one.setScale("x", { min, max });
      }
      group.leading = false;
    },
    leave() {
      group.members.delete(made);
      if (!group.members.size) cursors.delete(name);
    },
  };
}

function legend(traces) {
  return element("span", { class: "legend" }, traces.map((trace, place) => {
    if (trace.unnamed) return null;
    const number = (((trace.colour ?? place + 1) - 1) % COLOURS) + 1;
    return element("span", {}, element("i", { class: `swatch trace-${number}${trace.dashed ? " dashed" : ""}`, "aria-hidden": "true" }), trace.label);
  }));
}

function extent(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (value === null) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return low <= high ? [low, high] : [null, null];
}

function summary(title, unit, traces, note) {
  const parts = traces.map((trace) => {
    const [low, high] = extent(trace.values);
    return `${trace.label} from ${number(low)} to ${number(high)}${unit ? ` ${unit}` : ""}`;
  });
  return `Plot of ${title}: ${parts.join("; ")}.${note ? ` ${note}` : ""} Plus and minus zoom, arrow keys pan, Escape shows the whole range.`;
}

function numbers(title, unit, traces) {
  return element("table", { class: "visually-hidden" },
    element("caption", {}, `Minimum and maximum of ${title}${unit ? ` in ${unit}` : ""}`),
    element("thead", {}, element("tr", {}, ["trace", "minimum", "maximum"].map((name) => element("th", { scope: "col" }, name)))),
    element("tbody", {}, traces.map((trace) => element("tr", {}, element("th", { scope: "row" }, trace.label),
      extent(trace.values).map((value) => element("td", {}, number(value)))))));
}

function saveCsv(title, unit, x, traces, data) {
  const head = [`${x.label} [${x.unit}]`, ...traces.map((trace) => (unit ? `${trace.label} [${unit}]` : trace.label))];
  const quoted = (cell) => (/[",\n]/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell);
  const rows = data[0].map((_, row) => data.map((column) => column[row] ?? "").join(","));
  const link = element("a", {
    href: URL.createObjectURL(new Blob([[head.map(quoted).join(","), ...rows].join("\n"), "\n"], { type: "text/csv" })),
    download: `${title.replace(/[^\w-]+/g, "_")}.csv`,
  });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
