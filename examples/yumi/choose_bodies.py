"""Choose physically consistent bodies that weigh what a YuMi arm weighs, near the study's Table 3.

Table 3 lists base parameters, most of them sums over several bodies, and was fitted without regard to whether
bodies are physically consistent, so the bodies are those closest to it among all that are. A log-determinant
term keeps each body near a plausible ellipsoid, without which the optimum would be flat discs and needles.
Sources: Table 3
of the study; Khalil & Dombre (2002), ch. 9, for the grouping along a chain of revolute joints; Lee, Wensing &
Park, IEEE T-RO 36(1), 2020, for the distance.

Run ``python -m examples.yumi.choose_bodies`` to write `bodies.json` again.
"""

import json
from typing import Final

import cvxpy as cp
import numpy as np

from examples.yumi import arm

TABLE_3: Final = {
    "ZZ1": (0.064, 14.58), "MX1": (0.093, 8.35), "MY1": (0.391, 7.58), "XX2": (0.214, 8.94),
    "XZ2": (0.101, 2.57), "ZZ2": (0.224, 6.30), "MX2": (0.267, 4.09), "MY2": (-0.784, 0.68),
    "XX3": (-0.105, 10.55), "XY3": (-0.112, 6.45), "XZ3": (-0.027, 12.65), "YZ3": (0.139, 5.07),
    "ZZ3": (0.054, 11.55), "MX3": (0.106, 3.88), "MY3": (0.025, 8.03), "XX4": (-0.033, 14.70),
    "XY4": (0.026, 4.53), "XZ4": (0.009, 16.92), "MX4": (0.054, 7.01), "MY4": (0.244, 1.71),
    "XX5": (-0.023, 10.44), "XY5": (-0.038, 2.93), "XZ5": (0.010, 4.43), "ZZ5": (-0.0047, 6.94),
    "MX5": (0.0304, 2.43), "MY5": (0.0135, 8.00), "XY6": (0.0078, 7.12), "XZ6": (-0.0017, 13.94),
    "ZZ6": (0.0033, 10.20), "MX6": (0.0041, 15.18), "MY6": (-0.0166, 6.69), "YZ7": (-0.0013, 12.04),
    "ZZ7": (0.0007, 6.87), "MY7": (0.0033, 7.35),
}  # fmt: skip  # a table
"""Value and relative deviation in percent of each base parameter, by the name of its own link's column."""

SHAPES: Final = (
    (3.1, (0.010, 0.010, -0.020), (0.060, 0.060, 0.070)),
    (2.2, (0.015, -0.110, 0.010), (0.055, 0.110, 0.055)),
    (1.8, (0.020, 0.000, -0.080), (0.060, 0.055, 0.080)),
    (1.2, (0.020, 0.090, 0.010), (0.055, 0.100, 0.055)),
    (0.8, (0.015, 0.000, -0.080), (0.045, 0.045, 0.090)),
    (0.3, (0.010, 0.005, 0.000), (0.040, 0.040, 0.040)),
    (0.1, (0.000, 0.005, -0.010), (0.035, 0.035, 0.025)),
)
"""A plausible body per link: mass in kg, mass centre in m, half axes of a homogeneous ellipsoid in m.

The masses are kept as they stand here, 9.5 kg together, which is what one arm of the robot weighs."""

CLOSENESS: Final = 0.03
"""Weight of Table 3 against the plausible bodies; small enough to keep every body thick."""


def pseudo_inertia_of_shape(
    mass: float, centre: tuple[float, ...], half_axes: tuple[float, ...]
) -> np.ndarray:
    """Give the 4x4 pseudo-inertia of a homogeneous ellipsoid: second moment m a2/5 along a half axis a."""
    lever = np.append(centre, 1.0)
    spread = np.zeros((4, 4))
    spread[:3, :3] = np.diag(mass * np.square(half_axes) / 5.0)
    return np.asarray(spread + mass * np.outer(lever, lever))


def column(matrix: cp.Expression, symbol: str) -> cp.Expression:
    """Read one of the ten inertial parameters from a pseudo-inertia."""
    diagonal = {"XX": (1, 2), "YY": (0, 2), "ZZ": (0, 1)}
    if symbol in diagonal:
        first, second = diagonal[symbol]
        return matrix[first, first] + matrix[second, second]
    places = {
        "XY": (0, 1, -1),
        "XZ": (0, 2, -1),
        "YZ": (1, 2, -1),
        "MX": (0, 3, 1),
        "MY": (1, 3, 1),
        "MZ": (2, 3, 1),
    }
    row, other, sign = places.get(symbol, (3, 3, 1))
    return sign * matrix[row, other]


def grouped(bodies: list[cp.Variable]) -> dict[str, cp.Expression]:
    """Group every link's columns into its antecedent's, from the hand to the shoulder.

    For a revolute joint YY, MZ and M of link j have no column of their own: they enter those of XX_j and of
    link j - 1.
    """
    table = [{symbol: column(body, symbol) for symbol in arm.SYMBOLS} for body in bodies]
    for number in reversed(range(arm.JOINTS)):
        own = table[number]
        yy, mz, m = own["YY"], own["MZ"], own["M"]
        own["XX"] = own["XX"] - yy
        own["ZZ"] = own["ZZ"] + (arm.ROTOR_INERTIA[number] if number < 2 else 0.0)
        if number:
            d, r = arm.D[number], arm.R[number]
            c, s = np.cos(arm.ALPHA[number]), np.sin(arm.ALPHA[number])
            moment = mz + r * m
            along = yy + 2 * r * mz + r**2 * m
            gains = {
                "XX": along, "XY": d * s * moment, "XZ": -d * c * moment, "YY": c**2 * along + d**2 * m,
                "YZ": c * s * along, "ZZ": s**2 * along + d**2 * m,
                "MX": d * m, "MY": -s * moment, "MZ": c * moment, "M": m,
            }  # fmt: skip  # a table
            below = table[number - 1]
            for symbol, gain in gains.items():
                below[symbol] = below[symbol] + gain
    return {
        f"{symbol}{number}": value for number, own in enumerate(table, 1) for symbol, value in own.items()
    }


def choose() -> tuple[list[np.ndarray], dict[str, float]]:
    """Solve for the bodies; give their pseudo-inertias and the base parameters that Table 3 lists."""
    bodies = [cp.Variable((4, 4), symmetric=True) for _ in SHAPES]
    base = grouped(bodies)
    misfit = cp.hstack(
        [
            (base[name] - value) / (abs(value) * max(percent, 5.0) / 100.0)
            for name, (value, percent) in TABLE_3.items()
        ]
    )
    plausible = [pseudo_inertia_of_shape(*shape) for shape in SHAPES]
    distance = sum(
        cp.trace(np.linalg.solve(assumed, np.eye(4)) @ body) - cp.log_det(body)
        for assumed, body in zip(plausible, bodies, strict=True)
    )
    objective = cp.Minimize(CLOSENESS * cp.sum_squares(misfit) + distance)
    masses = [body[3, 3] == shape[0] for body, shape in zip(bodies, SHAPES, strict=True)]
    cp.Problem(objective, masses).solve(solver=cp.CLARABEL)
    return [np.asarray(body.value) for body in bodies], {name: float(base[name].value) for name in TABLE_3}


def as_body(matrix: np.ndarray) -> dict[str, object]:
    """Write a pseudo-inertia as mass, mass centre and inertia about it, rounded as a data sheet would."""
    mass = matrix[3, 3]
    centre = matrix[:3, 3] / mass
    spread = matrix[:3, :3] - mass * np.outer(centre, centre)
    inertia = np.trace(spread) * np.eye(3) - spread
    return {
        "mass": round(float(mass), 4),
        "centre": [round(float(value), 5) for value in centre],
        "inertia": [[round(float(value), 7) for value in row] for row in inertia],
    }


def main() -> None:
    """Write `bodies.json`."""
    matrices, base = choose()
    document = {
        "how": "closest to Table 3 among physically consistent bodies that weigh 9.5 kg together",
        "units": {"mass": "kg", "centre": "m, in the link frame", "inertia": "kg m2, about the centre"},
        "links": [as_body(matrix) for matrix in matrices],
        "table_3": {
            name: {"study": TABLE_3[name][0], "here": round(value, 5)} for name, value in base.items()
        },
    }
    (arm.HERE / "bodies.json").write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
