// List the files of a result and the shell commands that reproduce it.
import { follow } from "../base/api.js";
import { element, fill } from "../base/dom.js";

const FILES = [
  ["report", "Report: one HTML file that opens offline and prints"],
  ["results", "Result document (JSON) with every number of this page"],
  ["results/parameters.csv", "Base parameters with standard deviations and %P"],
  ["results/standard_parameters.csv", "Standard parameters: one feasible representative"],
  ["results/residuals.parquet", "Motion, torque and residual of every joint at every sample used"],
  ["results/robot.urdf", "URDF with the identified bodies"],
  ["results/robot.xml", "MJCF, for MuJoCo"],
  ["results/robot.sdf", "SDFormat, for Gazebo"],
  ["results/parameters.yaml", "The robot and its parameters as YAML"],
  ["results/parameters.mat", "The same for MATLAB"],
  ["results/parameters.h", "Inverse dynamics in C"],
  ["results/model.json", "The whole model, extended by what was found, to be loaded again"],
];

/** Show the files and the commands. */
export function showExport(container, { job }) {
  const here = location.origin;
  const body = { kind: job.kind, robot: job.robot, logs: job.logs, options: job.options };
  const commands = [
    `curl -H 'Content-Type: application/json' -H 'Prefer: wait=60' \\\n  -d '${JSON.stringify(body).replaceAll("'", "'\\''")}' \\\n  ${here}/v1/jobs`,
    `curl ${here}${job.links.results}`,
  ].join("\n");
  fill(container,
    element("p", { class: "hint" }, "Standard parameters that are identifiable only in combination are one feasible representative of many with the same dynamics. Every file lists them."),
    element("ul", { class: "files" }, FILES.map(([path, title]) => {
      const name = path === "results" ? "results.json" : path === "report" ? "report.html" : path.split("/").pop();
      const link = element("a", { href: `${job.links.self}/${path}`, download: path === "report" ? null : name }, name);
      return element("li", {}, follow(link), element("span", {}, title));
    })),
    element("h3", {}, "Reproduce from a shell"),
    element("pre", { tabindex: "0" }, element("code", {}, commands)),
    element("p", { class: "hint" }, "With a key: add -H 'Authorization: Bearer …'. A repeated request returns the existing job."));
}
