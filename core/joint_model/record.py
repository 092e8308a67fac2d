"""Read the motion of one joint off a log in which no other joint moves.

Positions are taken as measured: what filters them would move the mode of the joint. The speed's sign alone
comes from filtered positions.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from ..arrays import JointVector, Mask, SampleMask, Samples
from ..dynamics.jacobian import jacobian
from ..errors import ExcitationError, LogError
from ..log.model import JointLog
from ..robot.joint_units import prismatic_joints
from ..robot.model import RobotModel
from ..signals.condition import Motion, condition
from ..signals.marks import long_runs
from ..signals.segment import Segment

MOST_ROWS: Final = 60_000
"""Rows that are taken, from the first on: a minute at 1 kHz determines a handful of numbers. Set by hand."""
FEWEST_ROWS: Final = 1000
"""Fewer rows leave blocks of fewer than ten, of which no deviation is known. Set by hand."""
STILL_SHARE: Final = 0.02
"""Travel of another joint, as a share of this joint's, up to which it stands: a held joint is flexible.
Joints of the other kind may travel `STILL_ANGLE` or `STILL_WAY`. Set by hand."""
STILL_ANGLE, STILL_WAY = 0.01, 1e-3
"""Travel in rad and m up to which any other joint stands."""
LEAST_TRAVEL: Final = 50.0
"""Travel over the RMS of the position's noise below which a joint does not move. Set by hand."""
PARALLEL: Final = 0.01
"""Sine of the angle between axis and gravity up to which gravity gives no torque: 0.6 degrees."""
FITTED: Final = 0.75
"""Share of the rows that is fitted; the rest, one stretch at the end, is held out."""


@dataclass(frozen=True, eq=False)
class JointRecord:
    """Hold the measured motion of one joint on an even clock."""

    joint: int
    """From 1."""
    segment: Segment
    position: Samples
    """Rad or m."""
    direction: Samples
    """Mean of the speed's sign from each sample to the next, in which a torque is held."""
    torque: Samples
    """N m or N."""
    standing: SampleMask
    """Where the joint stands for `STILL_SECONDS` or longer."""
    gravity: bool
    """Whether gravity may give a torque."""
    travels: JointVector
    allowed: JointVector
    """Travel of every joint, and that up to which the others stand."""
    prismatic: bool

    @property
    def step(self) -> float:
        """Give the time between samples, s."""
        return 1.0 / self.segment.rate_hz

    @property
    def fitted(self) -> int:
        """Count the rows that are fitted."""
        return int(FITTED * len(self.position))


def read_joint(log: JointLog, robot: RobotModel, joint: int) -> JointRecord:
    """Read the longest stretch of a log between its gaps.

    Raises
    ------
    LogError
        If the log does not fit the robot, has no torque of this joint, or is too short.
    ExcitationError
        If the joint does not move, or others move too.
    """
    motion = condition(log, robot)
    segment = max(motion.segments, key=lambda one: one.samples)
    kept = min(segment.kept, MOST_ROWS // motion.recipe.decimation)
    tile = segment.tile(motion.effort_scale, slice(0, kept))
    count = min(len(tile.state.position), MOST_ROWS)
    _check_length(count, log)
    positions = segment.measured_positions(0, count)
    prismatic = prismatic_joints(robot)
    travels = np.asarray(np.ptp(positions, axis=0))
    allowed = _allowed(travels, prismatic, joint)
    _check_motion(motion, joint, travels, allowed)
    _check_torque(segment, joint)
    speed, still = tile.state.velocity[:count, [joint - 1]], motion.recipe.still_speed[[joint - 1]]
    return JointRecord(
        joint=joint,
        segment=segment,
        position=np.ascontiguousarray(positions[:, joint - 1]),
        direction=_direction(speed[:, 0]),
        torque=np.ascontiguousarray(tile.torque[:count, joint - 1]),
        standing=np.asarray(long_runs(np.abs(speed) <= still, segment.still_samples)[:, 0]),
        gravity=_feels_gravity(robot, joint, np.median(positions, axis=0)),
        travels=travels,
        allowed=allowed,
        prismatic=bool(prismatic[joint - 1]),
    )


def _direction(speed: Samples) -> Samples:
    """Give the mean sign of a speed that changes evenly from each sample to the next."""
    ahead = np.append(speed[1:], speed[-1])
    size = np.abs(speed) + np.abs(ahead)
    return np.asarray(np.divide(speed + ahead, size, out=np.zeros_like(speed), where=size > 0.0))


def _check_torque(segment: Segment, joint: int) -> None:
    if segment.unmeasured[joint - 1]:
        raise LogError(
            f"the torque of joint {joint} was not measured",
            evidence={"joint": joint, "log": segment.log.name},
            remedy="map a measured torque or current of this joint",
        )


def _check_length(rows: int, log: JointLog) -> None:
    if rows < FEWEST_ROWS:
        raise LogError(
            "the longest stretch between gaps is too short for the model of a joint",
            evidence={"rows": rows, "at_least": FEWEST_ROWS, "log": log.name},
            remedy=f"record at least {FEWEST_ROWS} rows without gaps, better 20 s at 1 kHz",
        )


def _allowed(travels: JointVector, prismatic: Mask, joint: int) -> JointVector:
    """Give the travel up to which each joint stands."""
    any_joint = np.where(prismatic, STILL_WAY, STILL_ANGLE)
    alike = prismatic == prismatic[joint - 1]
    return np.where(alike, np.maximum(any_joint, STILL_SHARE * travels[joint - 1]), any_joint)


def _check_motion(motion: Motion, joint: int, travels: JointVector, allowed: JointVector) -> None:
    """Refuse a joint that stands, and others that do not."""
    noise = float(motion.recipe.position_noise[joint - 1])
    own = float(travels[joint - 1])
    if own <= LEAST_TRAVEL * noise:
        raise ExcitationError(
            f"joint {joint} does not move",
            evidence={"joint": joint, "travel": own, "position_noise": noise, "log": motion.log.name},
            remedy="give a log in which this joint moves and the others stand",
        )
    moving = [
        number
        for number in range(1, len(travels) + 1)
        if number != joint and travels[number - 1] > allowed[number - 1]
    ]
    if moving:
        raise ExcitationError(
            f"other joints move beside joint {joint}, and their motion acts on it",
            evidence={
                "moving": moving,
                "travel": [float(f"{travels[number - 1]:.4g}") for number in moving],
                "allowed": [float(f"{allowed[number - 1]:.4g}") for number in moving],
                "log": motion.log.name,
            },
            remedy=f"give a log in which joint {joint} moves alone, or identify the whole robot",
        )


def _feels_gravity(robot: RobotModel, joint: int, position: JointVector) -> bool:
    """Tell whether a joint turns about an axis that is not parallel to gravity."""
    link = next(number for number, link in enumerate(robot.links, start=1) if link.joint == joint)
    if robot.links[link - 1].kind == "prismatic":
        return False  # along a straight way the pull of gravity is an offset
    axis = jacobian(robot, link, position[None])[0, 3:, joint - 1]
    size = float(np.linalg.norm(robot.gravity) * np.linalg.norm(axis))
    return bool(np.linalg.norm(np.cross(axis, robot.gravity)) > PARALLEL * size)
