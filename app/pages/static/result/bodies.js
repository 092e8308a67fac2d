// Physical consistency: bodies drawn on the chain, eigenvalues of the pseudo-inertias, and active constraints.
import { drawChain } from "../drawing/chain.js";
import { element, fill } from "../base/dom.js";
import { wide } from "../drawing/wide.js";
import { consistency, number, plural, relative } from "../base/words.js";

/** Show the bodies. */
export function showBodies(container, { document }) {
  const { feasibility, solver, bodies = [], robot } = document;
  const drawn = bodies.filter((body) => body.half_axes !== null).map((body) => ({
    link: body.link,
    centre: body.mass_centre,
    axes: body.axes.map((row) => row.map((value, column) => value * body.half_axes[column])),
    label: `link ${body.link}: ${number(body.mass, 3)} kg, half axes ${body.half_axes.map((value) => number(1000 * value, 3)).join(", ")} mm`,
  }));
  const figure = element("div", {});
  fill(container, element("div", { class: "split" },
    element("div", {}, figure, element("p", { class: "hint" }, "Each ellipsoid is the solid of uniform density with the link's identified mass, centre of mass and inertia. It is one feasible representative, the one closest to the prior. It does not show the shape of the link.")),
    element("div", {}, element("ul", { class: "facts" }, facts(feasibility, solver, robot)), eigenvalues(feasibility, bodies))));
  if (bodies.length) drawChain(figure, robot, { bodies: drawn });
  else fill(figure, element("p", { class: "soft" }, "The model has no bodies to draw."));
}

function facts(feasibility, solver, robot) {
  const mass = feasibility.mass_matrix_min_eigenvalue ?? {};
  const active = feasibility.active_constraints ?? [];
  const cost = solver.objective_ols > 0 ? solver.objective / solver.objective_ols - 1 : null;
  return [
    element("li", {}, element("strong", {}, feasibility.feasible ? "The identified parameters are physically consistent. " : "The identified parameters are physically inconsistent. "),
      `Those of ordinary least squares are ${consistency(feasibility.ols_feasible)}.`),
    cost === null ? null : element("li", {}, `Cost of the consistency constraint: squared error ${relative(100 * cost)} above the least-squares optimum.`),
    mass.workspace === undefined ? null : element("li", {}, `Mass matrix: smallest eigenvalue ${number(mass.trajectory, 3)} along the motion, ${number(mass.workspace, 3)} in ${plural("configuration", mass.configurations)} of the workspace, ${unitOfMassMatrix(robot)}.`),
    active.length ? activeConstraints(active) : element("li", {}, "No constraint is active: every body lies in the interior of the feasible set."),
    element("li", {}, `Solver: ${solver.status}, ${plural("iteration", solver.iterations)}.`),
  ];
}

// An eigenvalue of the mass matrix has a unit of its own where all joints are of one kind.
function unitOfMassMatrix({ joints }) {
  const prismatic = joints.filter((joint) => joint.type === "prismatic").length;
  if (!prismatic) return "in kg m²";
  return prismatic === joints.length ? "in kg" : "in SI units, with entries in kg m², kg m and kg";
}

// List bodies on the boundary of the feasible set and parameters at their lower bound.
function activeConstraints(active) {
  const links = active.filter((name) => name.startsWith("pseudo_inertia_")).map((name) => name.split("_").pop());
  const [large, dense] = ["size_", "density_"].map((kind) => active.filter((name) => name.startsWith(kind)).map((name) => name.split("_").pop()));
  const others = active.filter((name) => !/^(pseudo_inertia|size|density)_/.test(name));
  return [
    large.length ? element("li", {}, `As large as its link may be: the body of link ${listed(large)}.`) : null,
    dense.length ? element("li", {}, `As small as the densest metal allows: the body of link ${listed(dense)}.`) : null,
    links.length ? element("li", {}, `${links.length === 1 ? "The body of link" : "The bodies of links"} ${listed(links)} ${links.length === 1 ? "lies" : "lie"} on the boundary of the feasible set (active semidefinite constraint).`) : null,
    others.length ? element("li", {}, `At the lower bound: ${listed(others)}.`) : null,
  ];
}

function listed(names) {
  return names.length < 2 ? names.join() : `${names.slice(0, -1).join(", ")} and ${names.at(-1)}`;
}

function eigenvalues(feasibility, bodies) {
  const smallest = feasibility.pseudo_inertia_min_eigenvalue ?? [];
  if (!smallest.length) return null;
  return wide(element("table", {},
    element("caption", {}, "A body is physically consistent if its pseudo-inertia matrix has no negative eigenvalue. The entries are in kg m², kg m and kg, so an eigenvalue has no unit of its own; only its sign matters."),
    element("thead", {}, element("tr", {}, ["Link", "Mass, kg", "Half axes, mm", "Smallest eigenvalue, SI"].map((name) => element("th", { scope: "col" }, name)))),
    element("tbody", {}, smallest.map((value, index) => {
      const body = bodies[index];
      return element("tr", {}, element("th", { scope: "row" }, index + 1),
        element("td", {}, number(body?.mass, 3)),
        element("td", {}, body?.half_axes ? body.half_axes.map((one) => number(1000 * one, 3)).join(" × ") : "–"),
        element("td", { class: value < 0 ? "poor" : null }, number(value, 3)));
    }))), "Links");
}
