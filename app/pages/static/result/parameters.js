// The table of base parameters with error bars, %P and grouping; it can be sorted, filtered, copied and saved.
import { follow } from "../base/api.js";
import { element, fill, svg } from "../base/dom.js";
import { wide } from "../drawing/wide.js";
import { number, relative } from "../base/words.js";
import { overTime } from "./over_time.js";

const POOR_PERCENT = 30;
const COLUMNS = [
  { id: "name", title: "Parameter", of: (row) => row.name },
  { id: "value", title: "Value", of: (row) => row.value, right: true },
  { id: "interval", title: "95 % interval", of: (row) => halfWidth(row) },
  { id: "percent", title: "%P", of: (row) => row.relative_deviation_percent ?? Infinity, right: true },
  { id: "ols", title: "Least squares", of: (row) => row.value_ols, right: true },
  { id: "essential", title: "Essential", of: (row) => (row.essential ? 0 : 1) },
  { id: "grouping", title: "Grouping", of: (row) => row.grouping },
];

/** Show the table of base parameters, those of the model that the result states. */
export function showParameters(container, { job, document }) {
  const rows = document.base_parameters;
  const state = { column: null, descending: false, joint: "all" };
  const body = element("tbody", {});
  const said = element("p", { class: "hint", role: "status" });
  const heads = COLUMNS.map((column) => element("th", { scope: "col", class: column.right ? "right" : null, "aria-sort": "none" },
    element("button", { type: "button", class: "sort", on: { click: () => sort(column) } }, column.title)));
  const filter = element("select", { id: "joint-filter", on: { change: () => { state.joint = filter.value; write(); } } },
    element("option", { value: "all" }, "all joints"),
    [...new Set(rows.map((row) => row.joint))].map((joint) => element("option", { value: joint }, `joint ${joint}`)));
  fill(container,
    document.estimation ? element("p", { class: "hint" }, document.estimation.statements.join(" ")) : null,
    document.plain ? element("p", { class: "hint" }, `${document.model.statement}. Parameters added by findings are marked as new.`) : null,
    element("div", { class: "row spread toolbar" },
      element("span", { class: "row" }, element("label", { for: "joint-filter" }, "Show"), filter, said),
      element("span", { class: "row" },
        element("button", { type: "button", class: "tiny", on: { click: copy } }, "Copy as CSV"),
        element("button", { type: "button", class: "tiny", on: { click: saveLatex } }, "Save as LaTeX"),
        follow(element("a", { class: "button tiny", href: job.links.parameters_csv, download: "parameters.csv" }, "CSV file")))),
    wide(element("table", { class: "parameters" },
        element("caption", {}, "Physically consistent estimate and ordinary least squares (without the consistency constraint). %P: standard deviation in percent of the value. Error bars are relative to the value."),
        element("thead", {}, element("tr", {}, heads)), body), "Base parameters"),
    overTime(document));
  write();

  function sort(column) {
    state.descending = state.column === column ? !state.descending : false;
    state.column = column;
    heads.forEach((head, place) => head.setAttribute("aria-sort", COLUMNS[place] !== column ? "none" : state.descending ? "descending" : "ascending"));
    write();
  }

  function shown() {
    const kept = rows.filter((row) => state.joint === "all" || row.joint === Number(state.joint));
    if (state.column === null) return kept;
    const sign = state.descending ? -1 : 1;
    return [...kept].sort((a, b) => sign * compared(state.column.of(a), state.column.of(b)));
  }

  function write() {
    const kept = shown();
    fill(body, kept.map(line));
    said.textContent = `${kept.length} of ${rows.length} parameters`;
  }

  async function copy() {
    try {
      await navigator.clipboard.writeText(asCsv(shown()));
      said.textContent = "Copied to the clipboard.";
    } catch {
      said.textContent = "The browser refused access to the clipboard; use the CSV file.";
    }
  }

  function saveLatex() {
    const link = element("a", { href: URL.createObjectURL(new Blob([asLatex(shown())], { type: "application/x-latex" })), download: "parameters.tex" });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }
}

function line(row) {
  const poor = row.relative_deviation_percent === null || row.relative_deviation_percent > POOR_PERCENT;
  return element("tr", {},
    element("th", { scope: "row" }, row.name, row.new ? element("span", { class: "chip" }, "new") : null),
    element("td", { class: "right" }, number(row.value), " ", element("span", { class: "unit" }, row.unit === "1" ? "" : row.unit)),
    element("td", {}, bar(row)),
    element("td", { class: `right${poor ? " poor" : ""}` }, relative(row.relative_deviation_percent)),
    element("td", { class: "right soft" }, number(row.value_ols)),
    element("td", {}, row.essential ? "yes" : "no"),
    element("td", { class: "grouping" }, row.grouping));
}

// The interval relative to the value: the middle is the value, the whole width is three times it; zero is a line.
function bar(row) {
  const reach = halfWidth(row);
  const size = Math.abs(row.value);
  const share = size > 0 ? Math.min(reach / size, 1.5) : 1.5;
  const half = (share / 1.5) * 58;
  const [low, high] = row.interval_95 ?? [row.value - reach, row.value + reach];
  const said = `95 % interval ${number(low)} to ${number(high)}${row.unit === "1" ? "" : ` ${row.unit}`}`;
  const zero = 60 - Math.sign(row.value || 1) * (1 / 1.5) * 58;
  return svg("svg", { class: "errorbar", viewBox: "0 0 120 16", role: "img", "aria-label": said }, svg("title", {}, said),
    svg("path", { class: "zero", d: `M${zero.toFixed(1)} 2V14` }),
    svg("path", { class: share > 1 ? "reach poor" : "reach", d: `M${(60 - half).toFixed(1)} 8H${(60 + half).toFixed(1)}M${(60 - half).toFixed(1)} 4.5V11.5M${(60 + half).toFixed(1)} 4.5V11.5` }),
    svg("circle", { cx: 60, cy: 8, r: 3 }));
}

function halfWidth(row) {
  return row.interval_95 ? (row.interval_95[1] - row.interval_95[0]) / 2 : 1.96 * row.standard_deviation;
}

function compared(a, b) {
  return typeof a === "string" ? a.localeCompare(b, "en", { numeric: true }) : a - b;
}

function asCsv(rows) {
  const names = ["name", "joint", "unit", "value", "value_ols", "standard_deviation", "relative_deviation_percent", "essential", "grouping"];
  const cell = (value) => (/[",\n]/.test(String(value ?? "")) ? `"${String(value).replaceAll('"', '""')}"` : String(value ?? ""));
  return `${[names, ...rows.map((row) => names.map((name) => row[name]))].map((line) => line.map(cell).join(",")).join("\n")}\n`;
}

function asLatex(rows) {
  const text = (value) => String(value).replace(/([_%&#$])/g, "\\$1");
  const shown = (value) => `$${number(value).replaceAll("−", "-").replace(/e(-?\d+)/, "\\cdot 10^{$1}")}$`;
  const lines = rows.map((row) => `${text(row.name)} & ${shown(row.value)} & ${shown(row.standard_deviation)} & ${row.relative_deviation_percent === null ? "--" : shown(row.relative_deviation_percent)} & ${shown(row.value_ols)} & ${text(row.unit)} \\\\`);
  return ["\\begin{tabular}{lrrrrl}", "\\hline", "Parameter & Value & Standard deviation & \\%P & Least squares & Unit \\\\", "\\hline", ...lines, "\\hline", "\\end{tabular}", ""].join("\n");
}
