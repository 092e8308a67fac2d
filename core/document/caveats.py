"""Say in every file what its numbers are: which are known only together, and what the file leaves out."""

from collections.abc import Iterable

import numpy as np

from .identified import IdentifiedRobot

SOURCE = "Written by Veritorque from measured motion. Units are SI, angles are in rad, joints count from 1."
REPRESENTATIVE = (
    "The standard parameters (masses, mass centres, inertias, drives) are one feasible representative: "
    "every set of them with the same base parameters gives the same torque on every motion. "
    "Do not read a single mass off this file unless it is identifiable individually."
)
TITLES = {
    "individually": "Identifiable individually",
    "in_combination": "Identifiable only in combination",
    "no": "Without effect on any torque",
}


def caveats(identified: IdentifiedRobot) -> tuple[str, ...]:
    """Say what the numbers are, which of them are known only in combination, and in which."""
    return (
        SOURCE,
        REPRESENTATIVE,
        *by_identifiability(identified),
        *(
            ["Base parameters, which the motion did tell: " + "; ".join(_groupings(identified)) + "."]
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
    """Say what a format has no place for, with the numbers; nothing where there are none."""
    listed = "; ".join(values)
    sentence = f"{format_name} has no place for {what}, which this file leaves out: {listed}."
    return (sentence,) if listed else ()


def rotors(identified: IdentifiedRobot) -> list[str]:
    """Write the rotors' inertias joint by joint."""
    return per_joint(identified, "IA", "kg m2 (slide: kg)")


def per_joint(identified: IdentifiedRobot, symbol: str, unit: str) -> list[str]:
    """Write a drive's parameter joint by joint, as ``joint_1 0.02 kg m2``; zeros are left out."""
    joints = identified.robot.joints
    return [
        f"{joint.name} {float(value)!r} {unit}"
        for joint, value in zip(joints, identified.of_joints(symbol), strict=True)
        if value
    ]


def of_motors(identified: IdentifiedRobot) -> list[str]:
    """Write the coupled motors in words."""
    found = []
    for motor in identified.motors:
        one = motor.coupling
        names = [identified.robot.joints[joint - 1].name for joint in one.joints]
        speed = " + ".join(f"{weight:g} {name}" for weight, name in zip(one.weights, names, strict=True))
        found.append(
            f"motor {one.name} turns with {speed} and has IAM {motor.rotor_inertia!r} kg m2, "
            f"FVM {motor.viscous!r} N m s/rad, FCM {motor.coulomb!r} N m"
        )
    return found


def smoothing(identified: IdentifiedRobot) -> tuple[str, ...]:
    """Say over what speeds the sign of Coulomb friction was smoothed; nothing where it was not."""
    widths = next((term.widths for term in identified.model.terms if term.name == "coulomb"), ())  # type: ignore[attr-defined]  # Coulomb friction alone has them
    if not np.any(widths):
        return ()
    listed = ", ".join(f"{width:g}" for width in widths)
    return (f"Coulomb friction was identified as FC tanh(v / w) with w = {listed} rad/s (m/s) per joint.",)


def _groupings(identified: IdentifiedRobot) -> list[str]:
    return [f"{one.name} = {one.grouping}" for one in identified.base]
