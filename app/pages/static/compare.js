// Compare two studies side by side: settings, results, and differences in standard deviations.
import { get } from "./base/api.js";
import { showDifferences } from "./result/differences.js";
import { element, fill } from "./base/dom.js";
import { showError } from "./base/problem.js";
import { KINDS, ago, plain, short } from "./base/words.js";

const SIDES = ["left", "right"];
const container = document.getElementById("compare");

try {
  await start();
} catch (error) {
  showError(container, error);
}

async function start() {
  const [jobs, names] = await Promise.all([successful(), namesOf()]);
  if (jobs.length < 2) {
    fill(container, element("p", { class: "notice" }, jobs.length ? "There is only one finished study; a comparison needs two." : "There are no finished studies yet."),
      element("div", { class: "actions" }, element("a", { class: "button primary", href: "/new" }, "New study")));
    return;
  }
  const asked = new URLSearchParams(location.search);
  const chosen = { left: asked.get("left") ?? asked.get("first"), right: asked.get("right") };
  const missing = Object.values(chosen).filter((id) => id && !known(id));
  chosen.left = known(chosen.left) ?? jobs.find((job) => job.id !== chosen.right).id;
  chosen.right = known(chosen.right) ?? alike(jobs.find((job) => job.id === chosen.left)).id;
  const selects = SIDES.map((side) => {
    const select = element("select", { id: `choose-${side}`, on: { change: () => { chosen[side] = select.value; show(); } } },
      jobs.map((job) => element("option", { value: job.id }, nameOf(job, names))));
    return select;
  });
  const swap = element("button", { type: "button", class: "quiet", on: { click: () => { [chosen.left, chosen.right] = [chosen.right, chosen.left]; show(); } } }, "Swap");
  const result = element("div", { "aria-live": "polite" });
  fill(container, element("section", { class: "card choose" },
    SIDES.map((side, index) => element("div", { class: "field" }, element("label", { for: `choose-${side}` }, element("i", { class: `swatch trace-${index + 1}`, "aria-hidden": "true" }), index ? "Right study" : "Left study"), selects[index])), swap),
    missing.map((id) => element("p", { class: "notice" }, `The study ${short(id)} has no parameters to compare: it is not finished, of a kind without them, or deleted. Another one is shown.`)), result);
  await show();

  async function show() {
    SIDES.forEach((side, index) => { selects[index].value = chosen[side]; });
    history.replaceState(null, "", `/compare?${new URLSearchParams(chosen)}`);
    if (chosen.left === chosen.right) {
      fill(result, element("p", { class: "notice" }, "Left and right are the same study: choose another one."));
      return;
    }
    fill(result, element("p", { class: "waiting", role: "status" }, "Loading both results …"));
    const mine = { ...chosen };
    try {
      const studies = await Promise.all(SIDES.map((side) => study(jobs.find((job) => job.id === mine[side]))));
      if (mine.left === chosen.left && mine.right === chosen.right) showDifferences(result, studies);
    } catch (error) {
      showError(result, error);
    }
  }

  async function study(job) {
    return { job, name: nameOf(job, names), robot: names.get(job.robot) ?? short(job.robot), document: await get(job.links.results, { headers: { Accept: "application/json" } }) };
  }

  function known(id) {
    return jobs.some((job) => job.id === id) ? id : null;
  }

  // Choose the default second study: the newest other one of the same robot.
  function alike(job) {
    const others = jobs.filter((one) => one.id !== job.id);
    return others.find((one) => one.robot === job.robot && one.kind === job.kind) ?? others.find((one) => one.robot === job.robot) ?? others[0];
  }
}

async function successful() {
  const page = await get("/v1/jobs?limit=1000");
  return page.jobs.filter((job) => job.state === "successful" && job.links.report);
}

async function namesOf() {
  const [robots, logs] = await Promise.all([get("/v1/robots?limit=1000"), get("/v1/logs?limit=1000")]);
  return new Map([...robots.robots, ...logs.logs].map((one) => [one.id, one.name]));
}

function nameOf(job, names) {
  const logs = job.logs.map((id) => names.get(id) ?? short(id)).join(", ");
  return `${KINDS[job.kind] ?? plain(job.kind)} of ${names.get(job.robot) ?? short(job.robot)} from ${logs}, ${ago(job.created_at)}`;
}
