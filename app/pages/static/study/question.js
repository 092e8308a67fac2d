// Choose the analysis and its main options, and start it.
import { get, post } from "../base/api.js";
import { field, menu, readNumber } from "../base/controls.js";
import { element, fill } from "../base/dom.js";
import { showError } from "../base/problem.js";
import { ANALYSES, ago, plural } from "../base/words.js";

const { kinds: KINDS, estimators: ESTIMATORS, joint: OF_JOINT } = ANALYSES;

/**
 * Ask for the kind of analysis and its options.
 * @param {HTMLElement} container
 * @returns {{use: function(Object): void}} to be told `robot` and `logs`
 */
export function askQuestion(container) {
  const known = { robot: null, logs: [] };
  let kind = KINDS[0];
  const choices = { cutoff: "", fraction: "", estimator: ESTIMATORS[0].name, reference: "", joint: "1", order: OF_JOINT.orders[0].name, by: OF_JOINT.estimators[0].name, compared: new Set(ESTIMATORS.map(({ name }) => name)) };
  const reference = element("div", {});
  const single = field(
    "Estimator",
    menu(ESTIMATORS.map(({ name, title }) => [name, `${title} (${name})`]), ESTIMATORS[0].name, (value) => {
      choices.estimator = value;
    }),
  );
  const several = element("fieldset", { class: "choices" }, element("legend", {}, "Estimators"), ESTIMATORS.map(offer));
  const filters = [
    field("Filter cut-off, Hz", text("cutoff", "automatic"), "chosen from the bandwidth of the motion if empty"),
    field("Held out for validation, %", text("fraction", "20"), "0 to 50 % of each log, in blocks"),
  ];
  const named = (list) => list.map(({ name, title }) => [name, `${title} (${name})`]);
  const ofJoint = [
    field("Joint", text("joint", "1"), "counted from 1; the others stand still in the log"),
    field("Order", menu(OF_JOINT.orders.map(({ name, title }) => [name, title]), choices.order, (value) => {
      choices.order = value;
    })),
    field("Estimator of the joint", menu(named(OF_JOINT.estimators), choices.by, (value) => {
      choices.by = value;
    }), "closed loop: the log holds the references of its controller"),
  ];
  const missing = element("p", { class: "hint", role: "status" });
  const said = element("div", { class: "said", "aria-live": "polite" });
  const start = element("button", { type: "button", class: "primary large", on: { click: begin } }, "Start");
  fill(
    container,
    element(
      "fieldset",
      { class: "questions" },
      element("legend", { class: "visually-hidden" }, "Analysis"),
      KINDS.map((offered) =>
        element(
          "label",
          { class: "question" },
          element("input", {
            type: "radio",
            name: "question",
            value: offered.name,
            checked: offered === kind,
            on: {
              change: () => {
                kind = offered;
                show();
              },
            },
          }),
          element("span", {}, element("strong", {}, offered.title), element("span", { class: "hint" }, offered.hint)),
        ),
      ),
    ),
    element(
      "details",
      { class: "options" },
      element("summary", {}, "Options"),
      element(
        "div",
        { class: "fields" },
        filters,
        ofJoint,
        several,
        single,
        reference,
      ),
    ),
    element("div", { class: "actions" }, start, missing),
    said,
  );
  show();
  return {
    use(told) {
      Object.assign(known, told);
      if ("robot" in told) offerReferences().catch((error) => showError(said, error));
      show();
    },
  };

  function text(name, placeholder) {
    return element("input", {
      type: "text",
      inputmode: "decimal",
      placeholder,
      on: {
        input: (event) => {
          choices[name] = event.target.value;
        },
      },
    });
  }

  function offer({ name, title }) {
    const box = element("input", {
      type: "checkbox",
      checked: true,
      on: {
        change: (event) => {
          choices.compared[event.target.checked ? "add" : "delete"](name);
        },
      },
    });
    return element("label", {}, box, ` ${title} (${name})`);
  }

  function show() {
    const wants = [known.robot ? null : "robot", known.logs.length || !kind.takes_logs ? null : "log"].filter(Boolean);
    const joints = known.robot?.description.joints.filter((one) => !one.mimics).length;
    const odd = known.logs.find((log) => known.robot && log.joints !== joints);
    const amperes = known.logs.find((log) => known.robot && !log.channels.includes("torque"));
    const gainless = amperes && known.robot.description.joints.some((one) => !one.mimics && !(one.torque_constant && one.gear_ratio));
    start.disabled = wants.length > 0 || odd !== undefined || Boolean(gainless);
    missing.textContent = wants.length
      ? `Missing: ${wants.join(", ")}.`
      : odd
        ? `${odd.name} has ${plural("joint", odd.joints)}, ${known.robot.name} has ${joints}.`
        : gainless
          ? `${amperes.name} has currents, but ${known.robot.name} has no drive gains: enter the torque constant and gear ratio of every joint in its table.`
          : "";
    missing.classList.toggle("wrong", odd !== undefined || Boolean(gainless));
    reference.hidden = !kind.takes_reference;
    single.hidden = kind.compares || kind.asks_joint;
    several.hidden = !kind.compares;
    for (const one of filters) one.hidden = kind.asks_joint;
    for (const one of ofJoint) one.hidden = !kind.asks_joint;
  }

  async function offerReferences() {
    choices.reference = "";
    fill(reference);
    const { robot } = known;
    if (!robot) return;
    const { jobs } = await get("/v1/jobs?limit=100");
    if (known.robot !== robot) return; // another one was chosen meanwhile
    const earlier = jobs.filter((job) => job.robot === robot.id && job.links.report);
    const list = [
      ["", "a new identification from these logs"],
      robot.description.prior ? ["prior", "prior (bodies of its description)"] : null,
      ...earlier.map((job) => [
        job.id,
        `its ${KINDS.find(({ name }) => name === job.kind).title.toLowerCase()} of ${ago(job.created_at)}`,
      ]),
    ];
    fill(
      reference,
      field(
        "Reference",
        menu(list.filter(Boolean), "", (value) => {
          choices.reference = value;
        }),
        "with an earlier study, the diagnosis finds what has changed since",
      ),
    );
  }

  async function begin() {
    start.disabled = true;
    try {
      const job = await post("/v1/jobs", {
        kind: kind.name,
        robot: known.robot.id,
        logs: kind.takes_logs ? known.logs.map((log) => log.id) : [],
        options: options(),
      });
      location.assign(`/studies/${job.id}`);
    } catch (error) {
      showError(said, error);
      start.disabled = false;
    }
  }

  function options() {
    const asked = {};
    if (kind.asks_joint) return { joint: sent(choices.joint), order: choices.order, estimator: choices.by };
    if (choices.cutoff.trim()) asked.filter = { cutoff_hz: sent(choices.cutoff) };
    if (choices.fraction.trim())
      asked.validation = {
        fraction: Number.isFinite(readNumber(choices.fraction)) ? readNumber(choices.fraction) / 100 : choices.fraction,
      };
    if (kind.compares) asked.compare = ESTIMATORS.map(({ name }) => name).filter((name) => choices.compared.has(name));
    else if (choices.estimator !== ESTIMATORS[0].name) asked.estimator = choices.estimator;
    if (kind.takes_reference) asked.reference = choices.reference || null;
    return asked;
  }
}

/** A number where it is one; else the text, which the service refuses with the reason. */
function sent(text) {
  const read = readNumber(text);
  return Number.isFinite(read) ? read : text;
}
