"""Give the body of a payload finding in every named frame of its link, with what controllers take."""

import numpy as np

from ..arrays import LinkParameters, SquareMatrix
from ..diagnosis.causes.protocol import FittedCause
from ..diagnosis.causes.shared.bodies import body_of
from ..diagnosis.causes.shared.own_joint import end_links, links_by_joint
from ..diagnosis.result import Diagnosis, Finding
from ..precision.inference import POOR_PERCENT
from ..robot.inertia import from_mass_properties, mass_properties, transform_body
from ..robot.model import NamedFrame, RobotModel
from .controller_loads import CONTROLLERS, Load

FLANGES = ("tool0", "flange", "tool_flange", "ee_link")
"""Names of the frame of the controller, best first. ROS-Industrial calls `tool0` the all-zero tool frame of
the controller. A `flange` of that convention has x, not z, pointing outwards, and stands beside a `tool0`."""


def payload_row(finding: Finding, diagnosis: Diagnosis) -> dict[str, object] | None:
    """Write the body of a payload finding; None for other findings, or where no body was fitted."""
    if finding.cause != "payload_change" or finding.member is None:
        return None
    chosen = diagnosis.chosen
    solved: FittedCause = chosen.solved(chosen.members.index(finding.member))
    robot = diagnosis.dataset.robot
    joint = finding.joints[0]
    throughout = not solved.scalars
    link = (links_by_joint if throughout else end_links)(robot)[joint]
    return framed_payload(robot, link, solved.values, solved.covariance)


def framed_payload(
    robot: RobotModel, link: int, values: LinkParameters, covariance: SquareMatrix
) -> dict[str, object] | None:
    """Give a fitted body in every frame; None where no body is near the numbers."""
    body, distance = body_of(values, covariance)
    if not np.isfinite(distance) or abs(body[9]) <= 0.0:
        return None
    removed = bool(body[9] < 0.0)
    mass, centre, inertia = mass_properties(np.copysign(1.0, body[9]) * body)
    trace = np.array([1.0, 0, 0, 1.0, 0, 1.0, 0, 0, 0, 0])
    deviation = float(np.sqrt(max(trace @ covariance @ trace, 0.0)))
    known = 100.0 * deviation < POOR_PERCENT * float(np.trace(inertia))  # else a point mass serves better
    own = from_mass_properties(mass, centre, inertia if known else np.zeros((3, 3)))
    linked = NamedFrame(f"link {link} of the description", link, np.eye(3), np.zeros(3))
    named = [frame for frame in robot.frames if frame.link == link]
    flange = flange_of(named)
    return {
        "link": link,
        "removed": removed,
        "mass": mass,
        "inertia_known": known,
        "flange": None if flange is None else flange.name,
        "frames": [_framed(own, frame, flange) for frame in (linked, *named)],
    }


def flange_of(frames: list[NamedFrame]) -> NamedFrame | None:
    """Choose the frame that is the controller's; None where none is named so."""
    for name in FLANGES:
        for frame in frames:
            if frame.name == name or frame.name.endswith(f"_{name}"):
                return frame
    return None


def _framed(body: LinkParameters, frame: NamedFrame, flange: NamedFrame | None) -> dict[str, object]:
    load = load_in(body, frame)
    return {
        "frame": frame.name,
        "center_of_mass": load.centre,
        "inertia_at_com": load.inertia[np.triu_indices(3)],
        "paste": {name: write(load, frame.name) for name, write in CONTROLLERS.items()}
        if frame is flange
        else {},
    }


def load_in(body: LinkParameters, frame: NamedFrame) -> Load:
    """Express a body, given in its link's frame, in a frame that is fixed to the link."""
    turn = frame.rotation.T
    return Load(*mass_properties(transform_body(body, turn, -turn @ frame.translation)))
