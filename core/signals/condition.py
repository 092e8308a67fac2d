"""Condition a log: position, velocity, acceleration and torque on one clock, tile after tile.

The log's gap-free parts are conditioned one by one (see `segment`); the parallel filter follows when the
equations are written. Nothing is computed before the tiles are asked for, so a log's length costs no memory.
"""

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..arrays import JointVector, Matrix
from ..errors import LogError
from ..log.model import JointLog
from ..numerics.marked_runs import marked_runs
from ..robot.joint_units import prismatic_joints
from ..robot.model import RobotModel
from .parallel import Tile
from .recipe import FilterOptions, Recipe, choose_recipe
from .segment import Segment, gap_free

TILE_KEPT = 1024
"""Decimated samples of a tile: more of them share what its filters see beside it, and cost more memory."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Hold a log, its recipe and the factors that turn its effort channel into joint torque."""

    log: JointLog
    recipe: Recipe
    effort_scale: JointVector
    """Per joint: 1 for logged torque, torque constant times gear ratio for logged current."""
    blocks: int
    """Number of contiguous blocks the log is divided into for hold-out and bootstrap."""
    segments: tuple[Segment, ...] = field(repr=False)

    @cached_property
    def kept(self) -> int:
        """Count the decimated samples of all segments."""
        return sum(segment.kept for segment in self.segments)

    def tiles(self, blocks: Collection[int] | None = None) -> Iterator[Tile]:
        """Go once through some blocks of the motion (all by default); no others are conditioned."""
        borders = [self.kept * number // self.blocks for number in range(self.blocks + 1)]
        done = 0
        for segment in self.segments:
            owners = np.searchsorted(borders, done + np.arange(segment.kept), side="right") - 1
            wanted = np.ones(segment.kept, dtype=bool) if blocks is None else np.isin(owners, list(blocks))
            for begin, end in marked_runs(wanted).tolist():
                for start in range(begin, end, TILE_KEPT):
                    kept = slice(start, min(start + TILE_KEPT, end))
                    yield segment.tile(self.effort_scale, kept, owners[kept], follows=start > begin)
            done += segment.kept


def condition(
    log: JointLog,
    robot: RobotModel,
    options: FilterOptions | None = None,
    *,
    blocks: int = 20,
    number: int = 0,
) -> Motion:
    """Settle clock, recipe and torque channel of a log for a robot.

    Parameters
    ----------
    number
        Of the log among those that are studied together, from 0.

    Raises
    ------
    LogError
        If the log has another number of joints than the robot, or currents without declared constants, or no
        stretch between gaps that is long enough.
    """
    if log.joints != len(robot.joints):
        raise LogError(
            "the log and the robot have different numbers of joints",
            evidence={"log_joints": log.joints, "robot_joints": len(robot.joints), "log": log.name},
            remedy="map one position and one torque (or current) column to every joint of the robot",
        )
    recipe = choose_recipe(log, options or FilterOptions(), prismatic_joints(robot))
    motors = _shared_motors(robot)
    segments = tuple(
        replace(segment, number=number)
        for segment in (gap_free(log, recipe, span, motors) for span in log.segments)
        if segment is not None
    )
    return Motion(log, recipe, effort_scale(log, robot), blocks, segments)


def _shared_motors(robot: RobotModel) -> Matrix:
    """Give the weights of the joints' speeds in the motors that move several, motors x joints."""
    weights = np.zeros((len(robot.couplings), len(robot.joints)))
    for row, coupling in zip(weights, robot.couplings, strict=True):
        row[np.array(coupling.joints) - 1] = coupling.weights
    return weights


def effort_scale(log: JointLog, robot: RobotModel) -> JointVector:
    """Give, per joint, the torque per unit of the logged effort: 1 where torque itself is logged.

    Raises
    ------
    LogError
        If the log holds currents, and the robot does not say what torque a current gives.
    """
    check_currents(robot, log.channels, log.name)
    if "torque" in log.channels:
        return np.ones(len(robot.joints))
    return np.array(
        [float(joint.torque_constant or 0.0) * float(joint.gear_ratio or 0.0) for joint in robot.joints]
    )


def check_currents(robot: RobotModel, channels: tuple[str, ...], name: str) -> None:
    """Refuse a log of these channels that holds currents instead of torques, if they cannot become torques.

    Raises
    ------
    LogError
        If the robot does not say what torque a current gives.
    """
    undeclared = [
        joint.name for joint in robot.joints if joint.torque_constant is None or joint.gear_ratio is None
    ]
    if undeclared and "torque" not in channels:
        raise LogError(
            "the log holds currents, and the robot does not say what torque a current gives",
            evidence={"joints": undeclared, "log": name},
            remedy="declare torque_constant (N m/A) and gear_ratio of these joints in the robot's table; or "
            'map the currents as torque, with the N m/A of each joint: "current": null, "torque": '
            '{"columns": [...], "unit": "N m", "scale": [...]}',
        )


def without_standstill_mask(motion: Motion) -> Motion:
    """Give the same motion with standing samples counted as usable.

    For causes whose evidence lies at standstill.
    """
    recipe = replace(motion.recipe, still_speed=np.full_like(motion.recipe.still_speed, -1.0))
    segments = tuple(replace(segment, recipe=recipe) for segment in motion.segments)
    return replace(motion, recipe=recipe, segments=segments)
