"""Define what terms have in common: columns on one joint or on all of them, differences, rounding.

A concrete effect names its parameters and gives its columns; joints are counted from 1.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import JointSeries, Samples, Series
from ...robot.joint_units import joint_unit
from ...robot.model import Parameter, RobotModel
from ...signals.derivative import differentiate_throughout
from ...signals.state import MotionState
from ..term import Entry, Term

Symbol = tuple[str, str, float | None]
"""Name, SI unit (on a revolute joint), and physical lower bound (None where any sign is admissible)."""
ROUNDING = 1e-9
"""Share of the largest of some columns below which another one is rounding."""


@dataclass(frozen=True, eq=False)
class JointTerm(Term):
    """Name an effect by its kind and its joint."""

    joint: int
    """The joint under which the effect is reported, from 1; 0 for the robot as a whole."""
    symbols: ClassVar[tuple[Symbol, ...]] = ()
    kind: ClassVar[str] = ""

    @property
    def name(self) -> str:
        """Name the effect together with its joint."""
        return f"{self.kind}_{self.joint}"


class OneJointTerm(JointTerm):
    """Give columns that act on one joint only."""

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List the effect's parameters, in units of its joint."""
        return tuple(
            Parameter(symbol, self.joint, self.joint, joint_unit(robot, self.joint, unit), lower)
            for symbol, unit, lower in self.symbols
        )

    def entries(self, robot: RobotModel) -> tuple[Entry, ...]:
        """Put every parameter on the joint."""
        return tuple((self.joint - 1, index) for index in range(len(self.parameters(robot))))

    def series(self, robot: RobotModel, state: MotionState) -> Series:
        """Give the torque per unit parameter; where the robot matters, an effect gives its own."""
        del robot
        return np.array(self.columns(state), dtype=float).reshape(-1, len(state.position))

    def columns(self, state: MotionState) -> list[Samples]:
        """Give the torque on the joint per unit of each parameter."""
        raise NotImplementedError


class AllJointsTerm(JointTerm):
    """Give columns that act on every joint."""

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List the effect's parameters."""
        del robot
        return tuple(
            Parameter(symbol, self.joint, max(self.joint, 1), unit, lower)
            for symbol, unit, lower in self.symbols
        )

    def entries(self, robot: RobotModel) -> tuple[Entry, ...]:
        """Put every parameter on every joint."""
        count = len(self.parameters(robot))
        return tuple((joint, index) for index in range(count) for joint in range(len(robot.joints)))

    def series(self, robot: RobotModel, state: MotionState) -> Series:
        """Give the torque per unit parameter, joint after joint for each parameter."""
        torques = [torque.T for torque in self.torques(robot, state)]
        return np.ascontiguousarray(torques[0]) if len(torques) == 1 else np.vstack(torques)

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the torque of all joints per unit of each parameter."""
        raise NotImplementedError


class EachJointTerm(Term):
    """Give a parameter and a column of its own to every joint that has the effect."""

    symbol: ClassVar[Symbol]

    def joints(self, robot: RobotModel) -> tuple[int, ...]:
        """List the joints (from 0) that have it: those whose friction names it."""
        return tuple(index for index, joint in enumerate(robot.joints) if self.name in joint.friction)

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List the parameter of every joint that has it, in units of the joint."""
        symbol, unit, lower = self.symbol
        return tuple(
            Parameter(symbol, joint, joint, joint_unit(robot, joint, unit), lower)
            for joint in (index + 1 for index in self.joints(robot))
        )

    def entries(self, robot: RobotModel) -> tuple[Entry, ...]:
        """Pair each joint with its own parameter."""
        return tuple((joint, position) for position, joint in enumerate(self.joints(robot)))

    def series(self, robot: RobotModel, state: MotionState) -> Series:
        """Give the torque per unit parameter."""
        joints = self.joints(robot)
        rows = np.empty((len(joints), len(state.position)))
        for position, joint in enumerate(joints):
            rows[position] = self.column(joint, state)
        return rows

    def column(self, joint: int, state: MotionState) -> Samples | float:
        """Give the torque on a joint (from 0) per unit of its parameter."""
        raise NotImplementedError


def step_of(state: MotionState) -> float:
    """Give the time between samples, s."""
    if state.time is None or len(state.time) < 2:
        return 1.0
    return float((state.time[-1] - state.time[0]) / (len(state.time) - 1))


def rates(values: JointSeries, state: MotionState) -> tuple[JointSeries, JointSeries]:
    """Differentiate columns once and twice, as positions are differentiated."""
    rate_hz = 1.0 / step_of(state)
    first = differentiate_throughout(values, rate_hz)
    return first, differentiate_throughout(first, rate_hz)


def without_rounding(torques: Sequence[JointSeries]) -> list[JointSeries]:
    """Set columns to zero that differ from zero by rounding only.

    A planar arm does not react to a force across its plane: the computed column is rounding, and a fit would
    scale it to a parameter of any size.
    """
    sizes = [float(np.abs(column).max(initial=0.0)) for column in torques]
    least = ROUNDING * max(sizes)
    return [
        column if size > least else np.zeros_like(column) for column, size in zip(torques, sizes, strict=True)
    ]
