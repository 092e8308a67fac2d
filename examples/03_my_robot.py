"""Describe my own robot by its modified Denavit-Hartenberg table, and see what a motion of it can tell.

The letters are Khalil's: `d` and `alpha` lead from the antecedent's axis to this one, `r` and `theta_offset`
are along and about this one. **Craig writes a for d and d for r.** Run ``python -m examples.03_my_robot``; it
writes `my-arm.json`, which every command and the service take as a robot.
"""

import json
from math import pi
from pathlib import Path

from veritorque import base_parameters, robot_from_description
from veritorque.core.robot.plausibility import plausibility_warnings

#        alpha     d     r   theta_offset   position limits, rad
TABLE = (
    (0.0, 0.0, 0.40, 0.0, (-2.9, 2.9)),
    (-pi / 2, 0.05, 0.0, -pi / 2, (-1.9, 1.9)),
    (0.0, 0.45, 0.0, 0.0, (-2.4, 2.4)),
)


def description() -> dict[str, object]:
    """Write the table as a description: an upright arm of three joints."""
    joints = [
        {
            "name": f"joint_{number}",
            "type": "revolute",
            "antecedent": number - 1,
            "alpha": alpha,
            "d": d,
            "r": r,
            "theta_offset": offset,
            "limits": {"position": list(limits)},
        }
        for number, (alpha, d, r, offset, limits) in enumerate(TABLE, start=1)
    ]
    return {"name": "my-arm", "convention": "modified-dh", "joints": joints, "gravity": [0.0, 0.0, -9.81]}


def main() -> None:
    """Describe, check, and list what is identifiable."""
    robot = robot_from_description(description())
    for warning in plausibility_warnings(robot):
        print(f"rarely meant: {warning}")

    told = base_parameters(robot)
    counts = told["counts"]
    print(f"{counts['standard']} standard parameters, of which a motion tells {counts['base']} sums")
    for row in told["base_parameters"]:
        print(f"{row['name']:6} {row['unit']:10} {row['grouping']}")
    print(f"without effect on any torque: {', '.join(told['without_effect'])}")
    Path("my-arm.json").write_text(json.dumps(description(), indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
