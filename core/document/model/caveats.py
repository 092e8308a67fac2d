"""Write the notes of exported files: identifiability of the parameters, and what a format omits."""

from collections.abc import Iterable

import numpy as np

from ...robot.joint_units import joint_unit
from .identified import IdentifiedRobot

SOURCE = "Written by Veritorque from measured motion. SI units, angles in rad, joints counted from 1."
REPRESENTATIVE = (
    "The standard parameters (masses, centres of mass, inertias, drives) are one feasible representative: "
    "every set with the same base parameters gives the same torque for every motion. "
    "Do not use a single mass from this file unless it is identifiable individually."
)
TITLES = {
    "individually": "Identifiable individually",
    "in_combination": "Identifiable only in combination",
    "no": "Not identifiable (no effect on the torque)",
}


def caveats(identified: IdentifiedRobot) -> tuple[str, ...]:
    """List source, meaning and identifiability of the parameters, and remarks."""
    return (
        SOURCE,
        REPRESENTATIVE,
        *by_identifiability(identified),
        *(
            ["Base parameters, identified from the motion: " + "; ".join(_groupings(identified)) + "."]
            if identified.base
            else []
        ),
        *identified.remarks,
    )


def by_identifiability(identified: IdentifiedRobot) -> list[str]:
    """List the standard parameters' names under each title."""
    found = []
    for known, title in TITLES.items():
        pairs = zip(identified.model.parameters, identified.identifiable, strict=True)
        names = [parameter.name for parameter, kind in pairs if kind == known]
        found += [f"{title}: {', '.join(names)}."] if names else []
    return found


def without_place(format_name: str, what: str, values: Iterable[str]) -> tuple[str, ...]:
    """Note what a format cannot represent, with the numbers; empty if there are none."""
    listed = "; ".join(values)
    sentence = f"{format_name} cannot represent {what}; omitted from this file: {listed}."
    return (sentence,) if listed else ()


def rotors(identified: IdentifiedRobot) -> list[str]:
    """List the rotor inertias of the joints."""
    return per_joint(identified, "IA", "kg m2")


def per_joint(identified: IdentifiedRobot, symbol: str, unit: str) -> list[str]:
    """List a drive's nonzero parameters, as ``joint_1 0.02 kg m2``; `unit` is that of a revolute joint."""
    robot = identified.robot
    named = zip(robot.joints, identified.of_joints(symbol), strict=True)
    return [
        f"{joint.name} {float(value)!r} {joint_unit(robot, number, unit)}"
        for number, (joint, value) in enumerate(named, start=1)
        if value
    ]


def of_motors(identified: IdentifiedRobot) -> list[str]:
    """Describe the coupled motors."""
    found = []
    for motor in identified.motors:
        coupling = motor.coupling
        names = [identified.robot.joints[joint - 1].name for joint in coupling.joints]
        speed = " + ".join(f"{weight:g} {name}" for weight, name in zip(coupling.weights, names, strict=True))
        found.append(
            f"motor {coupling.name} rotates with {speed} and has IAM {motor.rotor_inertia!r} kg m2, "
            f"FVM {motor.viscous!r} N m s/rad, FCM {motor.coulomb!r} N m"
        )
    return found


def smoothing(identified: IdentifiedRobot) -> tuple[str, ...]:
    """Note the widths of smoothed Coulomb friction; empty if it was not smoothed."""
    widths = identified.model.smoothing_widths
    if not np.any(widths):
        return ()
    listed = ", ".join(f"{width:g}" for width in widths)
    return (f"Coulomb friction was identified as FC tanh(v / w) with w = {listed} rad/s (m/s) per joint.",)


def _groupings(identified: IdentifiedRobot) -> list[str]:
    return [f"{parameter.name} = {parameter.grouping}" for parameter in identified.base]
