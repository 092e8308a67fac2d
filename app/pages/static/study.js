// One study: live progress while it runs, its problem if it failed, its result if it succeeded.
import { get, request } from "./base/api.js";
import { element, fill } from "./base/dom.js";
import { followJob } from "./base/events.js";
import { problemBox, showError } from "./base/problem.js";
import { show } from "./result/result.js";
import { state } from "./study/studies.js";
import { KINDS, ago, duration, percent, plain, short } from "./base/words.js";

const container = document.getElementById("study");
const id = location.pathname.split("/")[2]; // stays as it is written in the address

try {
  await showStudy(await get(`/v1/jobs/${id}`));
} catch (error) {
  showError(container, error);
}

async function showStudy(job) {
  const badge = element("span", {}, state(job));
  const content = element("div", {});
  fill(
    container,
    element("div", { class: "row spread heading" }, element("h1", {}, await titleOf(job)), badge),
    content,
  );
  document.title = `${KINDS[job.kind] ?? plain(job.kind)} · Veritorque`;
  const ended = isOpen(job) ? await watch(job, content, badge) : job;
  fill(badge, state(ended));
  if (ended.state === "successful") await show(content, ended);
  else if (ended.state === "failed") fill(content, problemBox(ended.problem), again(ended));
  else
    fill(
      content,
      element("p", { class: "notice" }, `The study was dismissed ${ago(ended.finished_at)}.`),
      again(ended),
    );
}

async function titleOf(job) {
  const nameOf = async (path, otherwise) => {
    try {
      return (await get(path)).name;
    } catch {
      return short(otherwise); // deleted since
    }
  };
  const [robot, ...logs] = await Promise.all([
    nameOf(`/v1/robots/${encodeURIComponent(job.robot)}`, job.robot),
    ...job.logs.slice(0, 2).map((log) => nameOf(`/v1/logs/${encodeURIComponent(log)}`, log)),
  ]);
  const more = job.logs.length > 2 ? ` and ${job.logs.length - 2} more` : "";
  return `${KINDS[job.kind] ?? plain(job.kind)} of ${robot} from ${logs.join(", ")}${more}`;
}

async function watch(job, content, badge) {
  const stage = element("p", { class: "stage", role: "status" });
  const bar = element("progress", { max: 1, "aria-label": "Progress of the study" });
  const clock = element("span", { class: "soft" });
  const said = element("div", {});
  const cancel = element("button", { type: "button", on: { click: dismiss } }, "Cancel the study");
  fill(
    content,
    element("section", { class: "card progress" }, stage, bar, element("div", { class: "row spread" }, clock, cancel)),
    said,
  );

  let last = job;
  const tick = () => {
    const since = Date.parse(last.started_at ?? last.created_at);
    clock.textContent = last.started_at
      ? `running for ${duration(Math.max(0, (Date.now() - since) / 1000))}`
      : `created ${ago(last.created_at)}`;
  };
  const told = (now) => {
    last = now;
    const words =
      now.state === "accepted"
        ? "Waiting in the queue"
        : `${capital(plain(now.progress.stage || "starting"))}, ${percent(now.progress.fraction)}`;
    if (stage.textContent !== words) stage.textContent = words;
    bar.value = now.progress.fraction;
    fill(badge, state(now));
    tick();
  };
  const silent = () => {
    stage.textContent = "The service does not answer; retrying";
  };
  told(job);
  const timer = setInterval(tick, 1000);
  try {
    return await followJob(job.id, told, { silent });
  } finally {
    clearInterval(timer);
  }

  async function dismiss() {
    cancel.disabled = true;
    try {
      await request(job.links.self, { method: "DELETE" });
    } catch (error) {
      cancel.disabled = false;
      showError(said, error);
    }
  }
}

function again(job) {
  const same = new URLSearchParams([["robot", job.robot], ...job.logs.map((log) => ["log", log])]);
  return element(
    "div",
    { class: "actions" },
    element("a", { class: "button primary", href: `/new?${same}` }, "Change and start again"),
    element("a", { class: "button", href: "/" }, "All studies"),
  );
}

function isOpen(job) {
  return job.state === "accepted" || job.state === "running";
}

function capital(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
