// Choose logs: upload files or take uploaded ones, and show rate, columns, defects and channels of each.
import { get, ProblemError, upload } from "../base/api.js";
import { showChannels } from "./channels.js";
import { columnsOf } from "./columns.js";
import { dropZone, field, menu } from "../base/controls.js";
import { element, fill } from "../base/dom.js";
import { mappingForm } from "./mapping.js";
import { showError } from "../base/problem.js";
import { bytes, count, duration, number, percent, plain, plural } from "../base/words.js";

const ACCEPT = ".csv,.tsv,.txt,.dat,.parquet,.pq,.npz,.mat,.h5,.hdf5,.mcap,.db3,.bag";
const LISTED = 50;
const LONGEST_NAME = 200; // that the service keeps

/**
 * Offer the ways to logs.
 * @param {HTMLElement} container
 * @param {Object} options `wanted`: ids of logs to begin with; `chosen(logs)` called at every change
 * @returns {{use: function(Object): void}} to be told which robot they are of
 */
export function chooseLogs(container, { wanted = [], chosen }) {
  const cards = element("div", { class: "stack" });
  const said = element("div", { class: "said", "aria-live": "polite" });
  const earlier = element("div", {});
  const logs = new Map();
  let robot = null;
  let asked = null; // the form that stands open
  fill(
    container,
    element(
      "div",
      { class: "split even" },
      dropZone("Drop a log here", "or choose a file: CSV, Parquet, MATLAB, NPZ, MCAP or ROS bag (1 or 2)", ACCEPT, (file) =>
        take(file, null),
      ),
      earlier,
    ),
    said,
    cards,
  );
  offerEarlier();
  for (const id of wanted) read(id);
  return {
    use(chosenRobot) {
      robot = chosenRobot;
      for (const one of logs.values()) one.redraw();
      asked?.use(robot);
    },
  };

  async function offerEarlier() {
    try {
      const known = (await get(`/v1/logs?limit=${LISTED}`)).logs;
      if (!known.length) return;
      const choices = [
        ["", "Choose a log"],
        ...known.map((log) => [log.id, `${log.name} (${plural("joint", log.joints)}, ${duration(log.duration_s)})`]),
      ];
      const list = menu(choices, "", (id) => {
        if (id) read(id);
        list.value = "";
      });
      fill(earlier, field("Or choose an uploaded log", list));
    } catch (error) {
      showError(said, error);
    }
  }

  async function read(id) {
    try {
      keep(await get(`/v1/logs/${encodeURIComponent(id)}`), null);
    } catch (error) {
      showError(said, error);
    }
  }

  // `form` is where the mapping was said, and stands again if the log is refused; `replaced` is the log as it was read before.
  async function take(file, mapping, form = null, replaced = null) {
    const bar = element("progress", { max: 1, value: 0, "aria-label": `Upload of ${file.name}` });
    const words = element("p", { class: "hint", role: "status" }, `Uploading ${file.name}, ${bytes(file.size)} …`);
    fill(said, element("div", { class: "upload" }, words, bar));
    const told = (fraction) => {
      bar.value = fraction;
      words.textContent =
        fraction < 1 ? `Uploading ${file.name}: ${percent(fraction)} of ${bytes(file.size)}` : `Reading ${file.name} …`;
    };
    const query = new URLSearchParams({ name: [...file.name].slice(-LONGEST_NAME).join("") });
    if (mapping !== null) query.set("mapping", JSON.stringify(mapping));
    try {
      const log = await upload(`/v1/logs?${query}`, file, { told });
      fill(said);
      forget(replaced);
      keep(log, file);
    } catch (error) {
      showError(said, withButtonFor(error));
      if (form !== null) {
        if (!form.isConnected) said.append(form);
      } else if (error?.problem?.type === "urn:veritorque:problem:log") await offerMapping(file, mappingPlace(error.problem), error.problem);
    }
  }

  // Where the columns are what is wrong, the form comes at once; where their values are, what is wrong stands alone at first.
  function mappingPlace({ evidence }) {
    const ofColumns = evidence?.columns && Object.values(evidence.columns).every((one) => typeof one !== "object");
    if (ofColumns) return said;
    const aside = element("details", {}, element("summary", {}, "Change the column mapping."));
    said.append(aside);
    return aside;
  }

  async function offerMapping(file, place, problem, replaced = null) {
    const columns = namesOf(await columnsOf(file), problem?.evidence?.columns);
    if (!columns.length) return;
    const form = element("div", {});
    if (problem === null) fill(place);
    place.append(form);
    asked = mappingForm(form, {
      columns,
      readings: problem?.evidence?.plausible_readings ?? {},
      suggested: problem?.evidence?.suggested_mappings ?? [],
      sliding: problem?.evidence?.suggested_if_prismatic ?? [],
      robot,
      finished: (mapping) => take(file, mapping, form, replaced),
    });
  }

  function forget(id) {
    const known = logs.get(id);
    known?.shown.destroy();
    known?.card.remove();
    logs.delete(id);
  }

  function keep(log, file) {
    forget(log.id);
    const plots = element("div", { class: "stack" });
    const again = element("div", {});
    const card = element(
      "article",
      { class: "log", "aria-label": `Log ${log.name}` },
      element(
        "div",
        { class: "row spread" },
        element("h3", {}, log.name),
        element(
          "span",
          { class: "row" },
          file === null
            ? null
            : element(
                "button",
                { type: "button", class: "tiny", on: { click: () => offerMapping(file, again, null, log.id) } },
                "Change column mapping",
              ),
          element(
            "button",
            { type: "button", class: "tiny", "aria-label": `Remove ${log.name}`, on: { click: remove } },
            "Remove",
          ),
        ),
      ),
      facts(log),
      again,
      defects(log),
      plots,
    );
    cards.append(card);
    const shown = showChannels(plots, log);
    logs.set(log.id, { card, log, shown, redraw: () => shown.use(robot) });
    shown.use(robot);
    chosen([...logs.values()].map((one) => one.log));

    function remove() {
      forget(log.id);
      chosen([...logs.values()].map((one) => one.log));
    }
  }
}

// The service knows where a header lies below title lines; it may list the first columns only.
function namesOf(first, listed) {
  if (!Array.isArray(listed)) return first ?? [];
  return first !== null && listed.every((name) => first.includes(name)) ? first : listed;
}

function facts(log) {
  const rows = [
    ["Duration", `${duration(log.duration_s)}, ${count(log.samples)} samples`],
    ["Rate", `${number(log.rate_hz)} Hz`],
    ["Joints", log.joints],
    ["Channels", log.channels.join(", ")],
    log.ignored_columns.length ? ["Ignored columns", log.ignored_columns.join(", ")] : null,
  ].filter(Boolean);
  return element(
    "dl",
    { class: "facts" },
    rows.map(([name, value]) => element("div", {}, element("dt", {}, name), element("dd", {}, value))),
  );
}

/** Name the button below a refusal in place of the mapping that it applies, which the remedy writes out. */
function withButtonFor(error) {
  const { problem } = error ?? {};
  if (!problem?.evidence?.suggested_mappings) return error;
  const { suggested_mappings, suggested_if_prismatic, ...evidence } = problem.evidence;
  const remedy = "check the mapping that is suggested below and apply it, or map the columns yourself";
  return new ProblemError({ ...problem, remedy, evidence });
}

/** Defects that the user decides on, before anything is computed. */
const NEED_A_LOOK = new Set(["implausible_unit", "velocity_mismatch", "missing_values"]);

function defects(log) {
  if (!log.defects.length) return element("p", { class: "sound" }, "No defects found.");
  return element(
    "details",
    { class: "defects", open: log.defects.length <= 4 || log.defects.some((defect) => NEED_A_LOOK.has(defect.kind)) },
    element("summary", {}, `${plural("defect", log.defects.length)} found, marked in the plots`),
    element(
      "ul",
      {},
      log.defects.map((defect) => element("li", {}, element("strong", {}, plain(defect.kind)), ` ${defect.statement}`)),
    ),
  );
}
