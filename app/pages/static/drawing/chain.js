// Draw a robot as a stick figure that can be turned and posed: links as rods, joints as barrels or slides, bodies as ellipsoids.
import { element, fill, svg } from "../base/dom.js";
import {
  add,
  apply,
  IDENTITY,
  movingJoints,
  multiply,
  place,
  rangeOf,
  times,
  transposed,
  turnZ,
} from "./kinematics.js";
import { barrel, ellipsoid, floor, label, rods, triad } from "./shapes.js";
import { number, plural } from "../base/words.js";

const HALF = 100; // the drawing reaches from -HALF to HALF
const STEP = Math.PI / 24;

/**
 * Draw a robot into a container.
 * @param {HTMLElement} container
 * @param {Object} description of the robot, as the API answers it
 * @param {Object} [options]
 * @param {boolean} [options.sliders] whether joints can be moved
 * @param {{link: number, centre: number[], axes: number[][], label: string}[]} [options.bodies] ellipsoids on links counted
 *   from 1: centre (m) and semi-axes as the columns of a matrix (m), in the link's frame
 * @returns {{update: function(Object): void, destroy: function(): void}}
 */
export function drawChain(container, description, { sliders = true, bodies = [] } = {}) {
  let robot = description;
  let pose = [];
  let fit = null;
  const view = { yaw: -0.9, pitch: 0.32, zoom: 1 };
  const drawing = svg("svg", { viewBox: `${-HALF} ${-HALF} ${2 * HALF} ${2 * HALF}`, role: "img" });
  const stage = element(
    "div",
    {
      class: "stage3d",
      tabindex: "0",
      role: "group",
      "aria-label": "Figure of the robot. The arrow keys rotate it, plus and minus zoom.",
    },
    drawing,
  );
  const panel = element("div", { class: "sliders" });
  fill(
    container,
    element(
      "div",
      { class: "chain" },
      stage,
      element("p", { class: "hint" }, "Drag to rotate, or focus the figure and use the arrow keys."),
      panel,
    ),
  );
  stage.addEventListener("pointerdown", turn);
  stage.addEventListener("keydown", steer);
  stage.addEventListener("wheel", wheel, { passive: false });
  update(description);
  return { update, destroy: () => fill(container) };

  function update(changed) {
    const before = movingJoints(robot)
      .map((joint) => joint.type)
      .join();
    robot = changed;
    const joints = movingJoints(robot);
    if (pose.length !== joints.length || before !== joints.map((joint) => joint.type).join())
      pose = joints.map(resting);
    fit = ball(place(robot, pose).flatMap((one) => one.path));
    if (sliders)
      fill(
        panel,
        joints.map(slider),
        joints.length ? element("button", { type: "button", class: "tiny", on: { click: rest } }, "Zero pose") : null,
      );
    draw();
  }

  function rest() {
    pose = movingJoints(robot).map(resting);
    update(robot);
  }

  function slider(joint, index) {
    const [low, high] = rangeOf(joint);
    const turning = joint.type === "revolute";
    const shown = element("output", { class: "soft" });
    const told = () => {
      shown.textContent = turning ? `${Math.round((pose[index] * 180) / Math.PI)}°` : `${length(pose[index])} m`;
    };
    const id = `joint-${index + 1}-slider`;
    const input = element("input", {
      type: "range",
      id,
      min: low,
      max: high,
      step: (high - low) / 200,
      on: {
        input: () => {
          pose[index] = input.valueAsNumber;
          told();
          draw();
        },
      },
    });
    input.value = pose[index];
    told();
    return element(
      "div",
      { class: "slider" },
      element("label", { for: id }, joint.name ?? `joint ${index + 1}`),
      input,
      shown,
    );
  }

  function draw() {
    const places = place(robot, pose);
    const upright = uprightBy(robot.gravity ?? [0, 0, -1]);
    const view3 = multiply(
      [
        [1, 0, 0],
        [0, Math.sin(view.pitch), Math.cos(view.pitch)],
        [0, -Math.cos(view.pitch), Math.sin(view.pitch)],
      ],
      turnZ(view.yaw),
    );
    const camera = multiply(view3, upright);
    const { middle, radius } = fit;
    const scale = (view.zoom * HALF * 0.92) / radius;
    const flat = (point) => {
      const seen = apply(camera, add(point, times(middle, -1)));
      return [seen[0] * scale, -seen[1] * scale, seen[2]];
    };
    const size = radius * 0.075; // of joints and frames, m
    const shapes = [
      floor(radius, transposed(upright), flat),
      ...places.flatMap((one, index) => rods(one, index, flat)),
      ...places.map((one, index) => barrel(robot.joints[index], index, one, { size, camera, scale, flat })),
      ...bodies.map((body) => ellipsoid(body, places[body.link - 1], camera, scale, flat)),
      triad({ rotation: IDENTITY, origin: [0, 0, 0] }, size * 1.8, flat),
      ...ends(robot, places).map((one) => triad(one, size * 2.2, flat)),
    ].sort((a, b) => a.depth - b.depth);
    drawing.replaceChildren(
      ...shapes.map((shape) => shape.node),
      ...places.map((one, index) => label(index + 1, one, size, flat)),
    );
    drawing.setAttribute("aria-label", described(robot, places));
  }

  function turn(event) {
    stage.setPointerCapture(event.pointerId);
    let [x, y] = [event.clientX, event.clientY];
    const move = (now) => {
      view.yaw += (now.clientX - x) * 0.01;
      tilt((now.clientY - y) * 0.01);
      [x, y] = [now.clientX, now.clientY];
      draw();
    };
    stage.addEventListener("pointermove", move);
    stage.addEventListener("pointerup", () => stage.removeEventListener("pointermove", move), { once: true });
    stage.addEventListener("pointercancel", () => stage.removeEventListener("pointermove", move), { once: true });
  }

  function steer(event) {
    const actions = {
      ArrowLeft: () => {
        view.yaw -= STEP;
      },
      ArrowRight: () => {
        view.yaw += STEP;
      },
      ArrowUp: () => tilt(STEP),
      ArrowDown: () => tilt(-STEP),
      "+": () => zoom(1.2),
      "=": () => zoom(1.2),
      "-": () => zoom(1 / 1.2),
    };
    if (!(event.key in actions) || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    actions[event.key]();
    draw();
  }

  function wheel(event) {
    if (!event.ctrlKey) return; // the page scrolls; a pinch zooms
    event.preventDefault();
    zoom(Math.exp(-event.deltaY * 0.01));
    draw();
  }

  function tilt(angle) {
    view.pitch = Math.min(Math.max(view.pitch + angle, -Math.PI / 2), Math.PI / 2);
  }

  function zoom(factor) {
    view.zoom = Math.min(Math.max(view.zoom * factor, 0.3), 6);
  }
}

/** A length in m, to a tenth of a millimetre: what rounding leaves of zero is zero. */
function length(value) {
  return number(Math.round(value * 1e4) / 1e4, 3);
}

function resting(joint) {
  const [low, high] = rangeOf(joint);
  return Math.min(Math.max(0, low), high);
}

/** A ball around the base and some points: its middle and radius, m. */
function ball(points) {
  const all = [[0, 0, 0], ...points];
  const middle = [0, 1, 2].map((axis) => {
    const values = all.map((point) => point[axis]);
    return (Math.min(...values) + Math.max(...values)) / 2;
  });
  const radius = Math.max(...all.map((point) => Math.hypot(...add(point, times(middle, -1)))));
  return { middle, radius: radius > 1e-6 ? radius * 1.12 : 0.5 };
}

/** Turn the base frame so that gravity points down. Source: the smallest rotation that leads one unit vector to another. */
function uprightBy(gravity) {
  const strength = Math.hypot(...gravity);
  if (strength < 1e-9) return IDENTITY;
  const [x, y, z] = times(gravity, -1 / strength);
  if (z < -1 + 1e-9)
    return [
      [1, 0, 0],
      [0, -1, 0],
      [0, 0, -1],
    ];
  const k = 1 / (1 + z);
  return [
    [1 - x * x * k, -x * y * k, -x],
    [-x * y * k, 1 - y * y * k, -y],
    [x, y, z],
  ];
}

/** The frames that carry no other: the ends of the chain or of the tree's branches. */
function ends(robot, places) {
  const carriers = new Set(robot.joints.map((joint, index) => joint.antecedent ?? index));
  return places.filter((_, index) => !carriers.has(index + 1));
}

function described(robot, places) {
  const tip = places.at(-1).origin.map(length);
  const prismatic = robot.joints.filter((joint) => joint.type === "prismatic").length;
  return `${robot.name || "Robot"} with ${plural("joint", robot.joints.length)}${prismatic ? `, ${prismatic} of them prismatic` : ""}; in this pose the last frame is at ${tip.join(", ")} m from the base.`;
}
