"""Write a `RobotModel` as the JSON document it can be read from again, number for number.

A robot whose every link still agrees with its modified DH row is written as a table, any other one by frames.
A row that no longer gives its link's placement is not written, so that a corrected robot is never written as
the uncorrected one.
"""

import numpy as np

from ..errors import RobotError
from .description import FRAMES, MODIFIED_DH
from .model import INERTIAL_SYMBOLS, Ball, Coupling, Joint, Link, NamedFrame, RobotModel


def to_description(robot: RobotModel) -> dict[str, object]:
    """Write a robot as a description that `robot_from_description` reads back to the same robot.

    Raises
    ------
    RobotError
        If the joints are numbered against the order of their links, which a description cannot express.
    """
    owners = _owners(robot)
    tabular = owners == list(range(len(robot.links))) and all(map(_follows_its_row, robot.links))
    description: dict[str, object] = {
        "name": robot.name,
        "convention": MODIFIED_DH if tabular else FRAMES,
        "joints": [
            _entry(link, robot.joints[link.joint - 1], tabular=tabular, owner=index in owners)
            for index, link in enumerate(robot.links)
        ],
        "gravity": _floats(robot.gravity),
        "couplings": list(map(_coupling, robot.couplings)),
        "prior": None if robot.prior is None else list(map(_body, robot.prior)),
    }
    if robot.frames:
        description["frames"] = list(map(_named_frame, robot.frames))
    if robot.shapes is not None:
        description["shapes"] = list(map(_ball, robot.shapes))
    return description


def _coupling(coupling: Coupling) -> dict[str, object]:
    return {
        "name": coupling.name,
        "number": coupling.number,
        "joints": list(coupling.joints),
        "weights": list(coupling.weights),
    }


def _entry(link: Link, joint: Joint, *, tabular: bool, owner: bool) -> dict[str, object]:
    """Write a link, together with its joint if it owns it."""
    entry: dict[str, object] = {"name": joint.name if owner else link.name}
    if link.name != entry["name"]:
        entry["link"] = link.name
    entry |= {"type": link.kind, "antecedent": link.antecedent}
    entry |= _row(link) if tabular else _frame(link)
    return entry | (_drive(joint) if owner else {"mimics": joint.name})


def _owners(robot: RobotModel) -> list[int]:
    """Choose for every joint, in order, the link whose entry describes it; its other links mimic it."""
    owners: list[int] = []
    for number in range(1, len(robot.joints) + 1):
        after = owners[-1] + 1 if owners else 0
        moved = [index for index in range(after, len(robot.links)) if robot.links[index].joint == number]
        if not moved:
            raise RobotError(
                "the joints are numbered against the order of their links",
                evidence={"joint": number, "links": [link.joint for link in robot.links]},
                remedy="number the joints in the order in which the links name them",
            )
        owners.append(moved[0])
    return owners


def _follows_its_row(link: Link) -> bool:
    if link.row is None or (link.ratio, link.offset) != (1.0, 0.0):
        return False
    rotation, translation = link.row.placement()
    return np.array_equal(rotation, link.rotation) and np.array_equal(translation, link.translation)


def _row(link: Link) -> dict[str, object]:
    row = link.row
    if row is None:  # a table is only written where every link has its row
        return {}
    return {
        "alpha": row.alpha,
        "d": row.d,
        "r": row.r,
        "theta_offset": row.theta,
        "gamma": row.gamma,
        "b": row.b,
    }


def _frame(link: Link) -> dict[str, object]:
    return {
        "rotation": [_floats(line) for line in link.rotation],
        "translation": _floats(link.translation),
        "ratio": link.ratio,
        "offset": link.offset,
    }


def _drive(joint: Joint) -> dict[str, object]:
    limits = joint.limits
    return {
        "limits": {
            "position": None if limits.position is None else list(limits.position),
            "velocity": limits.velocity,
            "torque": limits.torque,
        },
        "rotor_inertia": joint.rotor_inertia,
        "friction": list(joint.friction),
        "torque_constant": joint.torque_constant,
        "gear_ratio": joint.gear_ratio,
    }


def _named_frame(frame: NamedFrame) -> dict[str, object]:
    return {
        "name": frame.name,
        "link": frame.link,
        "rotation": [_floats(line) for line in frame.rotation],
        "translation": _floats(frame.translation),
    }


def _body(body: np.ndarray) -> dict[str, object]:
    return {"standard": dict(zip(INERTIAL_SYMBOLS, _floats(body), strict=True))}


def _ball(shape: Ball | None) -> list[float] | None:
    return None if shape is None else [*shape.centre, shape.radius]


def _floats(values: np.ndarray) -> list[float]:
    return [float(value) for value in values]
