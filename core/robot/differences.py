"""List the differences of two robots that change their torque; names and limits do not.

A simulation can only be compared with a log where both are of one robot: the same tree, the same table, the
same gravity, the same declared friction, rotors and couplings.
"""

import numpy as np

from .model import Link, RobotModel

TOLERANCE = 1e-8
"""In m, rad and m/s2: documents are written with ten digits."""


def differences(first: RobotModel, second: RobotModel) -> tuple[str, ...]:
    """List what differs, in words; empty where the same motion needs the same torque.

    Bodies are not compared: they are what an identification finds.
    """
    if (len(first.joints), len(first.links)) != (len(second.joints), len(second.links)):
        return ("the number of joints or links",)
    found = []
    for number, (link, other) in enumerate(zip(first.links, second.links, strict=True), start=1):
        if not _same_link(link, other):
            found.append(f"the placement of link {number}")
    for number, (joint, other_joint) in enumerate(zip(first.joints, second.joints, strict=True), start=1):
        if (joint.rotor_inertia, set(joint.friction)) != (
            other_joint.rotor_inertia,
            set(other_joint.friction),
        ):
            found.append(f"the declared rotor inertia or friction of joint {number}")
    if not _is_close(first.gravity, second.gravity):
        found.append("gravity")
    if _coupling_rows(first) != _coupling_rows(second):
        found.append("the couplings")
    return tuple(found)


def _coupling_rows(robot: RobotModel) -> list[tuple[object, ...]]:
    return [(coupling.number, coupling.joints, coupling.weights) for coupling in robot.couplings]


def _same_link(link: Link, other: Link) -> bool:
    same = (link.kind, link.antecedent, link.joint) == (other.kind, other.antecedent, other.joint)
    numbers = [
        np.array([*own.rotation.ravel(), *own.translation, own.ratio, own.offset]) for own in (link, other)
    ]
    return same and _is_close(*numbers)


def _is_close(values: np.ndarray, others: np.ndarray) -> bool:
    return bool(np.abs(values - others).max() <= TOLERANCE)
