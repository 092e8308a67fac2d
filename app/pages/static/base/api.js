// Ask the service. Whatever fails becomes one kind of error, which carries the problem document.
import { askForKey, hasKey, keyHeaders } from "./key.js";

/** A failure with its problem document (RFC 9457): title, cause, evidence, remedy. */
export class ProblemError extends Error {
  constructor(problem) {
    super(problem.detail ?? problem.title);
    this.problem = problem;
  }
}

/**
 * Send a request, with the key where there is one.
 * @param {string} path
 * @param {Object} [options] method, json (sent as JSON), body, headers, signal
 * @returns {Promise<Response>} an answer that is a success
 * @throws {ProblemError}
 */
export async function request(path, { method = "GET", json, body, headers = {}, signal } = {}) {
  const sent = json === undefined ? { body } : { body: JSON.stringify(json) };
  const typed = json === undefined ? headers : { "Content-Type": "application/json", ...headers };
  for (;;) {
    const key = keyHeaders();
    const response = await answered(fetch(path, { method, signal, ...sent, headers: { ...typed, ...key } }));
    if (response.ok) return response;
    const problem = await problemOf(response);
    if (response.status !== 401 || !(await askForKey(problem, key))) throw new ProblemError(problem);
  }
}

/** Read a JSON document. */
export async function get(path, options = {}) {
  return (await request(path, options)).json();
}

/** Send a JSON document and read the one that is answered. */
export async function post(path, json) {
  return (await request(path, { method: "POST", json })).json();
}

/**
 * Upload a file while telling how much of it is there.
 * @param {string} path
 * @param {Blob} file
 * @param {Object} [options] mediaType; told(fraction); signal
 */
export async function upload(path, file, { mediaType = "application/octet-stream", told = () => {}, signal } = {}) {
  for (;;) {
    const key = keyHeaders();
    const { status, document } = await sent(path, file, mediaType, told, signal);
    if (status >= 200 && status < 300) return document;
    if (status !== 401 || !(await askForKey(document, key))) throw new ProblemError(document);
  }
}

/**
 * A link to something of the API. A browser sends no key along with a link, so with one the file is saved instead.
 */
export function follow(link) {
  link.addEventListener("click", async (event) => {
    if (!hasKey()) return;
    event.preventDefault();
    const file = await (await request(link.getAttribute("href"))).blob();
    const saved = document.createElement("a");
    saved.href = URL.createObjectURL(file);
    saved.download = link.download || `${link.pathname.split("/").pop()}${file.type.startsWith("text/html") ? ".html" : ""}`;
    saved.click();
    setTimeout(() => URL.revokeObjectURL(saved.href), 1000);
  });
  return link;
}

/** Turn whatever was thrown into a problem document. */
export function problemFrom(error) {
  if (error instanceof ProblemError) return error.problem;
  return {
    title: "Internal error of the page",
    cause: String(error?.message ?? error),
    evidence: {},
    remedy: "reload the page",
  };
}

async function answered(promise) {
  try {
    return await promise;
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new ProblemError(silence());
  }
}

function sent(path, file, mediaType, told, signal) {
  return new Promise((resolve, reject) => {
    const exchange = new XMLHttpRequest(); // fetch does not tell how much of a body was sent
    exchange.open("POST", path);
    exchange.responseType = "json";
    for (const [name, value] of Object.entries({ "Content-Type": mediaType, ...keyHeaders() }))
      exchange.setRequestHeader(name, value);
    exchange.upload.addEventListener("progress", (event) => told(event.total ? event.loaded / event.total : 0));
    exchange.addEventListener("load", () =>
      resolve({ status: exchange.status, document: exchange.response ?? silence() }),
    );
    exchange.addEventListener("error", () => reject(new ProblemError(silence())));
    exchange.addEventListener("abort", () => reject(new DOMException("aborted", "AbortError")));
    signal?.addEventListener("abort", () => exchange.abort());
    exchange.send(file);
  });
}

async function problemOf(response) {
  try {
    return await response.json();
  } catch {
    return {
      title: "The response cannot be read",
      cause: `the service answered with status ${response.status} and no problem document`,
      evidence: {},
      remedy: "try again",
    };
  }
}

function silence() {
  return {
    title: "The service does not answer",
    cause: "the connection failed or was closed",
    evidence: {},
    remedy: "check that the service is running, then try again",
  };
}
