// The rows of a modified Denavit-Hartenberg table as a form holds them: in SI, with the columns that it shows and their units.
const ANGLES = { deg: Math.PI / 180, rad: 1 };
const LENGTHS = { mm: 1e-3, m: 1 };
/** The columns of the form; `more` ones are shown on demand. */
export const COLUMNS = [
  { name: "alpha", kind: "angle", hint: "about x, from the previous z axis" },
  { name: "d", kind: "length", hint: "along x (Craig's a)" },
  { name: "theta_offset", label: "theta", kind: "angle", hint: "about z, at q = 0" },
  { name: "r", kind: "length", hint: "along z (Craig's d)" },
  { name: "low", label: "minimum q", kind: "own", optional: true },
  { name: "high", label: "maximum q", kind: "own", optional: true },
  { name: "gamma", kind: "angle", optional: true, more: true, hint: "branches: about the previous z axis" },
  { name: "b", kind: "length", optional: true, more: true, hint: "branches: along the previous z axis" },
  { name: "velocity", label: "speed limit", kind: "ownspeed", optional: true, more: true },
  { name: "torque", label: "torque limit", kind: "effort", optional: true, more: true },
  { name: "torque_constant", label: "torque constant", kind: "constant", optional: true, more: true },
  { name: "gear_ratio", label: "gear ratio", kind: "plain", optional: true, more: true },
];
const FRICTION = ["viscous", "coulomb", "offset"];
/** A joint before anything is typed. */
export const EMPTY = { type: "revolute", alpha: 0, d: 0, theta_offset: 0, r: 0 };

/** The unit of a column: of one row, or of all where they may differ. */
export function unitOf(column, rows, units) {
  const revolute = rows.some((row) => row.type === "revolute");
  const prismatic = rows.some((row) => row.type === "prismatic");
  const own = [revolute ? units.angle : null, prismatic ? units.length : null].filter(Boolean);
  return {
    angle: units.angle,
    length: units.length,
    own: own.join(" or "),
    ownspeed: own.map((unit) => `${unit}/s`).join(" or "),
    effort: [revolute ? "N m" : null, prismatic ? "N" : null].filter(Boolean).join(" or "),
    constant: "N m/A",
    plain: "",
  }[column.kind];
}

/** What a number of a column is multiplied with to be SI. */
export function factorOf(column, row, units) {
  const own = row.type === "revolute" ? ANGLES[units.angle] : LENGTHS[units.length];
  const factors = { angle: ANGLES[units.angle], length: LENGTHS[units.length], own, ownspeed: own };
  return factors[column.kind] ?? 1;
}

/** Read the rows of a description. Names that only count are left out, so that they go on counting. */
export function rowsOf(description) {
  return description.joints.map(({ name, limits, ...joint }) => ({
    ...joint,
    name: /^joint_\d+$/.test(name) ? undefined : name,
    low: limits?.position?.[0],
    high: limits?.position?.[1],
    velocity: limits?.velocity ?? undefined,
    torque: limits?.torque ?? undefined,
    torque_constant: joint.torque_constant ?? undefined,
    gear_ratio: joint.gear_ratio ?? undefined,
  }));
}

/** Leave a joint out; who sat on it sits on its carrier. */
export function without(rows, index) {
  const lower = (antecedent) => (antecedent === undefined || antecedent <= index ? antecedent : antecedent - 1);
  return rows.filter((_, at) => at !== index).map((row) => ({ ...row, antecedent: lower(row.antecedent) }));
}

/** Say what is wrong with rows before they are sent; null where nothing is. */
export function faultOf(rows) {
  for (const [index, row] of rows.entries()) {
    const typed = COLUMNS.map((column) => row[column.name]).find((value) => typeof value === "string");
    if (typed !== undefined) return `“${typed}” is not a number.`;
    if ((row.low === undefined) !== (row.high === undefined)) return `Joint ${index + 1} needs both position limits or none.`;
  }
  return null;
}

/** Write a row as the API takes a joint. */
export function jointOf(row, index) {
  const position = row.low !== undefined && row.high !== undefined ? [row.low, row.high] : null;
  return {
    name: row.name ?? `joint_${index + 1}`,
    type: row.type,
    antecedent: row.antecedent ?? index,
    alpha: row.alpha,
    d: row.d,
    r: row.r,
    theta_offset: row.theta_offset,
    gamma: row.gamma ?? 0,
    b: row.b ?? 0,
    limits: { position, velocity: row.velocity ?? null, torque: row.torque ?? null },
    rotor_inertia: row.rotor_inertia ?? true,
    friction: row.friction ?? FRICTION,
    torque_constant: row.torque_constant ?? null,
    gear_ratio: row.gear_ratio ?? null,
  };
}

/** Where the service says that a cell is, when it refuses it. */
export function pointerOf(index, column) {
  const place =
    { low: "limits/position", high: "limits/position", velocity: "limits/velocity", torque: "limits/torque" }[
      column.name
    ] ?? column.name;
  return `/joints/${index}/${place}`;
}
