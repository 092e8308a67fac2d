// The list of studies, newest first: kind, robot, logs, state, duration and links.
import { follow, get } from "../base/api.js";
import { element, fill } from "../base/dom.js";
import { showError } from "../base/problem.js";
import { KINDS, ago, duration, percent, plain, short } from "../base/words.js";

const AT_A_TIME = 10;
const AGAIN_MS = 2000;

/** Show the studies, keep unfinished ones up to date, and offer older ones. */
export async function showStudies(container) {
  try {
    const [names, page] = await Promise.all([namesOf(), jobsFrom(null)]);
    if (!page.jobs.length) {
      fill(container, element("p", { class: "soft" }, "No studies yet. Try the example above."));
      return;
    }
    const body = element(
      "tbody",
      {},
      page.jobs.map((job) => row(job, names)),
    );
    const more = element(
      "button",
      { type: "button", hidden: page.next === null, on: { click: older } },
      "Older studies",
    );
    let next = page.next;
    fill(
      container,
      element(
        "div",
        { class: "wide" },
        element(
          "table",
          { class: "studies" },
          element(
            "thead",
            {},
            element(
              "tr",
              {},
              ["Study", "State", "Created", "Duration", "Links"].map((name) => element("th", { scope: "col" }, name)),
            ),
          ),
          body,
        ),
      ),
      element("div", { class: "actions" }, more),
    );
    refresh(body, names);

    async function older() {
      more.disabled = true;
      try {
        const found = await jobsFrom(next);
        body.append(...found.jobs.map((job) => row(job, names)));
        next = found.next;
        more.hidden = next === null;
      } catch (error) {
        showError(container, error);
      }
      more.disabled = false;
    }
  } catch (error) {
    showError(container, error);
  }
}

function jobsFrom(cursor) {
  return get(`/v1/jobs?limit=${AT_A_TIME}${cursor === null ? "" : `&cursor=${encodeURIComponent(cursor)}`}`);
}

async function namesOf() {
  const [robots, logs] = await Promise.all([get("/v1/robots?limit=1000"), get("/v1/logs?limit=1000")]);
  return new Map([...robots.robots, ...logs.logs].map((one) => [one.id, one.name]));
}

async function refresh(body, names) {
  while (body.isConnected) {
    const open = [...body.querySelectorAll("tr[data-open]")];
    if (!open.length) return;
    await new Promise((resolve) => setTimeout(resolve, AGAIN_MS));
    for (const old of open) {
      try {
        old.replaceWith(row(await get(`/v1/jobs/${old.dataset.open}`), names));
      } catch (error) {
        if (error?.problem?.status === 404) old.remove(); // deleted meanwhile; if the service is away, it is asked again
      }
    }
  }
}

function row(job, names) {
  const open = job.state === "accepted" || job.state === "running";
  const logs = job.logs.map((id) => names.get(id) ?? short(id));
  const shown = logs.length > 2 ? `${logs.slice(0, 2).join(", ")} and ${logs.length - 2} more` : logs.join(", ");
  return element(
    "tr",
    { "data-open": open ? job.id : null },
    element(
      "th",
      { scope: "row" },
      element(
        "a",
        { href: `/studies/${job.id}` },
        `${KINDS[job.kind] ?? plain(job.kind)} of ${names.get(job.robot) ?? short(job.robot)}`,
      ),
      element("div", { class: "hint" }, shown),
    ),
    element("td", { "data-label": "State" }, state(job)),
    element(
      "td",
      { "data-label": "Created" },
      element(
        "time",
        { datetime: job.created_at, title: new Date(job.created_at).toLocaleString() },
        ago(job.created_at),
      ),
    ),
    element("td", { "data-label": "Duration" }, took(job)),
    element("td", { "data-label": "Links" }, element("span", { class: "row" }, onward(job))),
  );
}

/** The state of a job as a badge, with how far it is. */
export function state(job) {
  const progress = job.state === "running" ? `, ${percent(job.progress.fraction)}` : "";
  return element(
    "span",
    { class: `state ${job.state}` },
    `${job.state === "accepted" ? "waiting" : job.state}${progress}`,
  );
}

function took(job) {
  return job.started_at && job.finished_at
    ? duration((Date.parse(job.finished_at) - Date.parse(job.started_at)) / 1000)
    : "–";
}

function onward(job) {
  if (job.state === "successful") {
    const result = element("a", { href: `/studies/${job.id}` }, "result");
    if (!job.links.report) return result;
    return [
      result,
      follow(element("a", { href: job.links.report, download: null }, "report")),
      element("a", { href: `/compare?first=${encodeURIComponent(job.id)}` }, "compare"),
    ];
  }
  if (job.problem) return element("span", { class: "hint" }, job.problem.cause);
  return job.state === "dismissed" ? "–" : element("a", { href: `/studies/${job.id}` }, "follow");
}
