// Take the way that a user's own log takes, with the log that ships with the service.
import { ProblemError, post, upload } from "../base/api.js";

const ROBOT = "yumi-left";
const LOGS = {
  identify: { address: "/static/example-log.csv", name: "log.csv" },
  diagnose: { address: "/static/example-hidden-log.csv", name: "hidden_log.csv" },
};

/**
 * Upload the example's log and ask for a job.
 * @param {"identify"|"diagnose"} kind
 * @returns {Promise<Object>} the job
 */
export async function tryExample(kind) {
  const { address, name } = LOGS[kind];
  const response = await fetch(address);
  if (!response.ok) throw new ProblemError(await response.json());
  const log = await upload(`/v1/logs?name=${name}`, await response.blob(), { mediaType: "text/csv" });
  return post("/v1/jobs", { kind, robot: ROBOT, logs: [log.id], options: {} });
}
