// Follow a job by its server-sent events. EventSource could not send a key, so the stream is read as a body.
import { get, ProblemError, request } from "./api.js";

const COME_BACK_MS = 2000;

/**
 * Tell every change of a job until it has ended.
 * @param {string} id
 * @param {function(Object): void} told called with the job, the first time at once
 * @param {Object} [options] `silent()` called whenever the service does not answer, before it is asked again; signal
 * @returns {Promise<Object>} the job at its end
 * @throws {ProblemError} if there is no such job
 */
export async function followJob(id, told, { silent = () => {}, signal } = {}) {
  let last = null;
  let job = null;
  for (;;) {
    try {
      const headers = last === null ? {} : { "Last-Event-ID": last };
      const response = await request(`/v1/jobs/${encodeURIComponent(id)}/events`, { headers, signal });
      if (response.status === 204) return job ?? get(`/v1/jobs/${encodeURIComponent(id)}`, { signal });
      for await (const event of eventsOf(response.body)) {
        last = event.id ?? last;
        job = JSON.parse(event.data);
        told(job);
        if (event.event === "end") return job;
      }
    } catch (error) {
      if (
        error.name === "AbortError" ||
        (error instanceof ProblemError && error.problem.status && error.problem.status < 500)
      )
        throw error;
      silent();
    }
    await new Promise((resolve) => setTimeout(resolve, COME_BACK_MS)); // the service was restarted, or the line broke
  }
}

async function* eventsOf(body) {
  let rest = "";
  for await (const piece of texts(body)) {
    const blocks = (rest + piece).split("\n\n");
    rest = blocks.pop();
    for (const block of blocks) {
      const fields = Object.fromEntries(
        block
          .split("\n")
          .filter((line) => !line.startsWith(":"))
          .map((line) => {
            const colon = line.indexOf(":");
            return [line.slice(0, colon), line.slice(colon + 1).trimStart()];
          }),
      );
      if (fields.data) yield fields;
    }
  }
}

async function* texts(body) {
  const reader = body.pipeThrough(new TextDecoderStream()).getReader();
  for (;;) {
    const { value, done } = await reader.read();
    if (done) return;
    yield value;
  }
}
