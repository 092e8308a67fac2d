// The shapes that a robot's figure is made of. Each gives a node and its depth, by which nearer ones are drawn later.
// `flat` leads from the base frame to the drawing: x and y in its units, and the depth in m.
import { svg } from "../base/dom.js";
import { add, apply, column, multiply, times } from "./kinematics.js";

function pathOf(points) {
  return points.map(([x, y], index) => `${index ? "L" : "M"}${x.toFixed(2)} ${y.toFixed(2)}`).join("");
}

/** The floor lies level, under the base: `level` leads from level coordinates to those of the base frame. */
export function floor(radius, level, flat) {
  const lines = [-2, -1, 0, 1, 2].flatMap((step) => {
    const [at, end] = [step * radius * 0.25, radius * 0.5];
    return [
      [
        [at, -end, 0],
        [at, end, 0],
      ],
      [
        [-end, at, 0],
        [end, at, 0],
      ],
    ];
  });
  return {
    depth: -Infinity,
    node: svg("path", {
      class: "floor",
      d: lines.map((ends) => pathOf(ends.map((end) => flat(apply(level, end))))).join(""),
    }),
  };
}

/** The rods of a link, from its antecedent's origin to its own. */
export function rods(one, index, flat) {
  return one.path.slice(1).map((corner, step) => {
    const ends = [flat(one.path[step]), flat(corner)];
    return {
      depth: (ends[0][2] + ends[1][2]) / 2,
      node: svg("path", { class: `rod rod-${(index % 2) + 1}`, d: pathOf(ends) }),
    };
  });
}

/** A joint: a barrel about its axis, or a bar along it. */
export function barrel(joint, index, one, { size, camera, scale, flat }) {
  const axis = column(one.rotation, 2);
  const half = joint.type === "prismatic" ? 1.5 * size : size;
  const ends = [-half, half].map((reach) => flat(add(one.origin, times(axis, reach))));
  const seen = apply(camera, axis);
  const [far, near] = seen[2] >= 0 ? ends : [...ends].reverse();
  const radius = size * scale * (joint.type === "prismatic" ? 0.45 : 0.75);
  const turn = `rotate(${((Math.atan2(-seen[1], seen[0]) * 180) / Math.PI).toFixed(1)})`;
  const cap = (at, name) =>
    svg("ellipse", {
      class: name,
      rx: Math.max(radius * Math.abs(seen[2]), 0.2).toFixed(2),
      ry: radius.toFixed(2),
      transform: `translate(${at[0].toFixed(2)} ${at[1].toFixed(2)}) ${turn}`,
    });
  const node = svg(
    "g",
    { class: `joint ${joint.type}` },
    cap(far, "side"),
    svg("path", { d: pathOf(ends), "stroke-width": (2 * radius).toFixed(2) }),
    cap(near, "cap"),
    svg("title", {}, `${joint.name ?? `joint ${index + 1}`}, ${joint.type}`),
  );
  return { depth: flat(one.origin)[2] + half / 2, node };
}

/** The axes of a frame: x red, y green, z blue. */
export function triad(one, size, flat) {
  const axes = [0, 1, 2].map((index) =>
    svg("path", {
      class: `axis axis-${"xyz"[index]}`,
      d: pathOf([flat(one.origin), flat(add(one.origin, times(column(one.rotation, index), size)))]),
    }),
  );
  return { depth: flat(one.origin)[2] + 2e-3, node: svg("g", {}, axes) };
}

/** The number of a joint, beside it. */
export function label(text, one, size, flat) {
  const [x, y] = flat(add(one.origin, times(column(one.rotation, 2), 1.7 * size)));
  return svg("text", { class: "number", x: x.toFixed(2), y: (y + 2).toFixed(2) }, String(text));
}

/** The outline of an ellipsoid seen from afar is an ellipse: of A = camera rotation axes, the first two rows of A A'. */
export function ellipsoid(body, one, camera, scale, flat) {
  const seen = multiply(camera, multiply(one.rotation, body.axes));
  const [xx, xy, yy] = [
    [0, 0],
    [0, 1],
    [1, 1],
  ].map(([a, b]) => seen[a].reduce((sum, value, k) => sum + value * seen[b][k], 0));
  const [mean, half] = [(xx + yy) / 2, Math.hypot((xx - yy) / 2, xy)];
  const [long, shortest] = [Math.sqrt(mean + half), Math.sqrt(Math.max(mean - half, 0))];
  const angle = (-Math.atan2(2 * xy, xx - yy) / 2) * (180 / Math.PI);
  const [x, y, depth] = flat(add(one.origin, apply(one.rotation, body.centre)));
  const node = svg(
    "ellipse",
    {
      class: `body body-${((body.link - 1) % 7) + 1}`,
      rx: (long * scale).toFixed(2),
      ry: (shortest * scale).toFixed(2),
      transform: `translate(${x.toFixed(2)} ${y.toFixed(2)}) rotate(${angle.toFixed(2)})`,
    },
    svg("title", {}, body.label),
  );
  return { depth, node };
}
