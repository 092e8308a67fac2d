// Where the frames of a described robot are, for drawing: the same rows and the same order of turns as the service's own.
// Source: Khalil & Kleinfinger, ICRA 1986; T = Rot(z, gamma) Trans(z, b) Rot(x, alpha) Trans(x, d) Rot(z, theta) Trans(z, r).

/** No rotation. */
export const IDENTITY = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];

/** The joints that move by themselves: those that mimic no other. */
export function movingJoints(description) {
  return description.joints.filter((joint) => !joint.mimics);
}

/**
 * Place every frame of a robot.
 * @param {Object} description as the API answers it, with modified-dh rows or frames
 * @param {number[]} coordinates of the joints that move by themselves, rad or m
 * @returns {{rotation: number[][], origin: number[], path: number[][]}[]} per joint: its frame in the base, and the corners
 *   of the link that leads there from its antecedent's origin, m
 */
export function place(description, coordinates) {
  const owners = movingJoints(description);
  const places = [];
  description.joints.forEach((joint, index) => {
    const owner = joint.mimics ? owners.findIndex((one) => one.name === joint.mimics) : owners.indexOf(joint);
    const moved = (joint.ratio ?? 1) * (coordinates[owner] ?? 0) + (joint.offset ?? 0);
    const carrier =
      (joint.antecedent ?? index) === 0
        ? { rotation: IDENTITY, origin: [0, 0, 0] }
        : places[(joint.antecedent ?? index) - 1];
    const own = joint.rotation ? byFrame(joint, moved) : byRow(joint, moved);
    const inBase = (point) => add(carrier.origin, apply(carrier.rotation, point));
    places.push({
      rotation: multiply(carrier.rotation, own.rotation),
      origin: inBase(own.path.at(-1)),
      path: [carrier.origin, ...own.path.map(inBase)],
    });
  });
  return places;
}

/** Limits of a joint for drawing; half a turn or a metre in either direction where none are known. */
export function rangeOf(joint) {
  return joint.limits?.position ?? (joint.type === "prismatic" ? [-1, 1] : [-Math.PI, Math.PI]);
}

/** A matrix times a vector. */
export function apply(matrix, vector) {
  return matrix.map((row) => row[0] * vector[0] + row[1] * vector[1] + row[2] * vector[2]);
}

/** The sum of two vectors. */
export function add(a, b) {
  return [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
}

/** The product of two matrices. */
export function multiply(a, b) {
  return a.map((row) =>
    [0, 1, 2].map((column) => row[0] * b[0][column] + row[1] * b[1][column] + row[2] * b[2][column]),
  );
}

/** The column of a matrix, as a vector. */
export function column(matrix, index) {
  return matrix.map((row) => row[index]);
}

/** A matrix, rows for columns. */
export function transposed(matrix) {
  return [0, 1, 2].map((index) => column(matrix, index));
}

/** Turn about x by an angle in rad. */
export function turnX(angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [
    [1, 0, 0],
    [0, c, -s],
    [0, s, c],
  ];
}

/** Turn about z by an angle in rad. */
export function turnZ(angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [
    [c, -s, 0],
    [s, c, 0],
    [0, 0, 1],
  ];
}

/** A vector times a number. */
export function times(vector, factor) {
  return vector.map((value) => value * factor);
}

function byRow(joint, moved) {
  const turning = joint.type === "revolute";
  const normal = turnZ(joint.gamma ?? 0);
  const axis = multiply(normal, turnX(joint.alpha));
  const up = [0, 0, joint.b ?? 0];
  const across = add(up, times(column(normal, 0), joint.d));
  const along = add(across, times(column(axis, 2), joint.r + (turning ? 0 : moved)));
  return { rotation: multiply(axis, turnZ(joint.theta_offset + (turning ? moved : 0))), path: [up, across, along] };
}

function byFrame(joint, moved) {
  if (joint.type === "revolute") return { rotation: multiply(joint.rotation, turnZ(moved)), path: [joint.translation] };
  return {
    rotation: joint.rotation,
    path: [joint.translation, add(joint.translation, times(column(joint.rotation, 2), moved))],
  };
}
