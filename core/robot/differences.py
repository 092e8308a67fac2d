"""Tell in what two robots differ as far as their torque knows: names and limits do not count.

A simulation can only be compared with a log where both are of one robot: the same tree, the same table, the
same way down, the same declared friction, rotors and couplings.
"""

import numpy as np

from .model import Link, RobotModel

TOLERANCE = 1e-8
"""In m, rad and m/s2: documents are written with ten digits."""


def differences(one: RobotModel, other: RobotModel) -> tuple[str, ...]:
    """List what differs, in words; empty where the same motion asks for the same torque.

    Bodies are not compared: they are what an identification finds.
    """
    if len(one.joints) != len(other.joints) or len(one.links) != len(other.links):
        return ("the number of joints or links",)
    found = []
    for number, (own, else_) in enumerate(zip(one.links, other.links, strict=True), start=1):
        if not _alike(own, else_):
            found.append(f"the placement of link {number}")
    for number, (mine, its) in enumerate(zip(one.joints, other.joints, strict=True), start=1):
        if (mine.rotor_inertia, set(mine.friction)) != (its.rotor_inertia, set(its.friction)):
            found.append(f"the declared rotor inertia or friction of joint {number}")
    if not _near(one.gravity, other.gravity):
        found.append("gravity")
    if [(c.number, c.joints, c.weights) for c in one.couplings] != [
        (c.number, c.joints, c.weights) for c in other.couplings
    ]:
        found.append("the couplings")
    return tuple(found)


def _alike(one: Link, other: Link) -> bool:
    same = (one.kind, one.antecedent, one.joint) == (other.kind, other.antecedent, other.joint)
    numbers = [
        np.array([*link.rotation.ravel(), *link.translation, link.ratio, link.offset])
        for link in (one, other)
    ]
    return same and _near(*numbers)


def _near(one: np.ndarray, other: np.ndarray) -> bool:
    return bool(np.abs(one - other).max() <= TOLERANCE)
