// Show the model of one joint: what the log shows of a spring, parameters, errors, and the frequency response.
import { follow } from "../base/api.js";
import { element, fill } from "../base/dom.js";
import { draw } from "../drawing/plot.js";
import { scrolling } from "../drawing/wide.js";
import { warnings } from "./headline.js";
import { number, relative } from "../base/words.js";

// Coherence of torque and position below which a measured point is noise.
const COHERENT = 0.5;
// Frequencies are drawn up to so many times the mode.
const BEYOND = 2.5;

/** Show in a sentence what the log shows, and the key figures. */
export function showJoint(container, { document }) {
  const { flexibility, models, joint } = document;
  const answers = models.filter((model) => !model.failure);
  const best = answers[answers.length - 1];
  const [first] = best.parameters;
  const mode = best.frequencies[0];
  const stiffness = best.parameters.find(({ name }) => name === "stiffness");
  const kind = flexibility.seen === false ? "bad" : flexibility.seen ? "good" : "";
  fill(container, element("section", { class: "card headline", "aria-label": "Summary" },
    warnings(document),
    element("p", { class: `verdict ${kind}` }, flexibility.seen === null ? `Rigid model of joint ${joint}` : flexibility.statement),
    element("div", { class: "figures" },
      figure(`${number(first.value)} ${first.unit}`, `${words(first.name)}, ± ${number(first.standard_deviation, 2)}`),
      stiffness ? figure(`${number(stiffness.value)} ${stiffness.unit}`, `stiffness, ± ${number(stiffness.standard_deviation, 2)}`) : null,
      mode ? figure(`${number(mode.value)} Hz`, `mode of motor against link, ± ${number(mode.standard_deviation, 2)} Hz`) : null,
      figure(relative(best.torque_error_percent), `torque error of the ${best.order} model below ${number(best.crossover_hz, 3)} Hz, on held-out rows`))));
}

export const JOINT = [
  ["parameters", "Parameters", showParameters],
  ["errors", "Errors", showErrors],
  ["response", "Frequency response", showResponse],
  ["evidence", "Evidence", showEvidence],
  ["export", "Export", showFiles],
];

function figure(big, small) {
  return element("div", {}, element("strong", {}, big), element("span", {}, small));
}

function words(name) {
  return name.replaceAll("_", " ");
}

function showParameters(container, { document: { models } }) {
  fill(container, models.map((model) => {
    const title = `${model.order === "rigid" ? "Rigid" : "Flexible"} model`;
    if (model.failure) return element("p", {}, `${title}: none. ${capital(model.failure.cause)}. Remedy: ${model.failure.remedy}.`);
    const rows = [...model.parameters, ...model.frequencies].map((row) => [
      `${words(row.name)} (${row.symbol})`, number(row.value), number(row.standard_deviation, 2),
      relative(row.relative_deviation_percent), row.interval_95.map((end) => number(end)).join(" to "), row.unit]);
    return table(title, ["Parameter", "Value", "Deviation", "%P", "95 % interval", "Unit"], rows);
  }));
}

function showErrors(container, { document: { models, controller } }) {
  const rows = models.map((model) => [model.order, relative(model.torque_error_percent), relative(model.torque_error_fitted_percent),
    number(model.crossover_hz, 3), relative(model.simulated_position_percent), String(model.steps.length), model.converged ? "yes" : "no"]);
  fill(container,
    table("Errors of torque and of simulated position", ["Model", "Torque, held out", "Torque, fitted", "Below, Hz", "Simulated position, held out", "Steps", "Converged"], rows),
    controller ? element("p", { class: "hint" }, `Controller of the log: ${controller.kind}, kp ${number(controller.kp)}, kd ${number(controller.kd)}; its command is recomputed to ${relative(controller.command_residual_percent)}.`)
      : element("p", { class: "hint" }, "Position is simulated under the log's controller, with the estimator clsrivc only."));
}

function showResponse(container, { document: { response, models, joint, joint_type: type } }) {
  const mode = Math.max(0, ...models.flatMap((model) => model.frequencies.map(({ value }) => value)));
  const last = mode ? BEYOND * mode : Infinity;
  const shown = response.frequency_hz.map((hertz, place) => [hertz, place]).filter(([hertz]) => hertz <= last).map(([, place]) => place);
  const hertz = shown.map((place) => response.frequency_hz[place]);
  const decibels = (gains) => shown.map((place) => decibel(gains[place], response.frequency_hz[place]));
  const seen = response.measured.map((gain, place) => (response.coherence[place] >= COHERENT ? gain : null));
  const unit = type === "prismatic" ? "dB of 1/kg" : "dB of 1/(kg m2)";
  draw(container, {
    title: `Acceleration per torque of joint ${joint}`, unit, height: 240,
    x: { label: "frequency", unit: "Hz", values: hertz },
    traces: [
      { label: "measured", values: decibels(seen), dots: true, colour: 7 },
      ...response.models.map(({ order, gain }, place) => ({ label: order, values: decibels(gain), colour: 2 + place, width: 1.8 })),
    ],
    note: `Measured points have a coherence of at least ${COHERENT}.`,
  });
}

function decibel(gain, hertz) {
  return gain ? 20 * Math.log10(gain * (2 * Math.PI * hertz) ** 2) : null;
}

function showEvidence(container, { document: { flexibility, data } }) {
  const evidence = Object.entries(flexibility.evidence).map(([name, value]) => [words(name), number(value)]);
  const rows = [
    ["samples", String(data.samples)], ["rate, Hz", number(data.rate_hz)],
    ["standing, % of the rows", number(data.standing_percent, 3)],
    ["travel of the joints", data.travels.map((travel) => number(travel, 3)).join(", ")],
    ["gravity in the model", data.gravity ? "yes" : "no"],
  ];
  fill(container,
    evidence.length ? table("What tells flexible from rigid", ["Quantity", "Value"], evidence) : null,
    table("Data", ["Quantity", "Value"], rows));
}

function showFiles(container, { job }) {
  const link = element("a", { href: `${job.links.self}/results`, download: "results.json" }, "results.json");
  fill(container, element("ul", { class: "files" }, element("li", {}, follow(link), element("span", {}, "Result document (JSON) with every number of this page"))));
}

function capital(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

function table(caption, headings, rows) {
  return scrolling(element("div", { class: "wide" }, element("table", { class: "checked" },
    element("caption", {}, caption),
    element("thead", {}, element("tr", {}, headings.map((heading) => element("th", { scope: "col" }, heading)))),
    element("tbody", {}, rows.map(([head, ...cells]) => element("tr", {}, element("th", { scope: "row" }, head), cells.map((cell) => element("td", {}, cell))))))), caption);
}
