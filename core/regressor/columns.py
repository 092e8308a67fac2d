"""Compute the model's non-zero columns for a stretch of motion: rigid body compiled, other terms as they are.

A `ColumnPlan` decides once which series are wanted and where each one goes; it is then applied stretch after
stretch.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Indices, Matrix, Series
from ..dynamics.model import DynamicModel
from ..dynamics.term import Term, is_linearised
from ..dynamics.terms.rigid_body import RigidBody
from ..robot.model import RobotModel
from ..signals.state import MotionState


@dataclass(frozen=True, eq=False)
class ColumnPlan:
    """Choose columns of a model's observation matrix."""

    model: DynamicModel
    """The model."""
    columns: tuple[int, ...]
    """Positions in `model.parameters` of the wanted parameters."""

    @cached_property
    def entries(self) -> tuple[tuple[int, int], ...]:
        """List the (joint, position in `columns`) pairs of the series, in the order `series` gives them."""
        index_of = {column: index for index, column in enumerate(self.columns)}
        wanted = {(joint, index_of[column]) for joint, column in self.model.entries if column in index_of}
        return tuple(sorted(wanted))

    @cached_property
    def is_instantaneous(self) -> bool:
        """Tell whether every series follows from the motion at its instant alone."""
        return not any(term.has_memory or is_linearised(term) for term in self.model.terms)

    @cached_property
    def rows_of(self) -> tuple[Indices, ...]:
        """Give, per joint, the rows of `series` that belong to it."""
        joints = np.array([joint for joint, _ in self.entries])
        return tuple(np.flatnonzero(joints == joint) for joint in range(len(self.model.robot.joints)))

    @cached_property
    def columns_of(self) -> tuple[Indices, ...]:
        """Give, per joint, the positions in `columns` of its non-zero series, in the order of `rows_of`."""
        columns = np.array([column for _, column in self.entries])
        return tuple(columns[rows] for rows in self.rows_of)

    def series(self, state: MotionState, robot: RobotModel | None = None) -> Series:
        """Give the torque per unit parameter, one row per entry.

        Parameters
        ----------
        robot
            Another robot than the model's, of the same joints and links with other lengths or gravity.
        """
        out = np.zeros((len(self.entries), len(state.position)))
        for fill in self._fills:
            fill(self.model.robot if robot is None else robot, state, out)
        return out

    @cached_property
    def _fills(self) -> "list[_RigidBodyFill | _TermFill]":
        slot_of = {(joint, self.columns[index]): row for row, (joint, index) in enumerate(self.entries)}
        fills: list[_RigidBodyFill | _TermFill] = []
        start = 0
        for term in self.model.terms:
            entries = term.entries(self.model.robot)
            targets = np.array(
                [slot_of.get((joint, start + parameter), -1) for joint, parameter in entries], dtype=int
            )
            if (targets >= 0).any():
                if isinstance(term, RigidBody):
                    fills.append(
                        _RigidBodyFill.prepare(
                            self.model.robot, dict(zip(entries, targets.tolist(), strict=True))
                        )
                    )
                else:
                    fills.append(_TermFill(term, targets))
            start += len(term.parameters(self.model.robot))
        return fills


@dataclass(frozen=True, eq=False)
class _TermFill:
    term: Term
    targets: Indices

    def __call__(self, robot: RobotModel, state: MotionState, out: Series) -> None:
        keep = self.targets >= 0
        out[self.targets[keep]] = self.term.series(robot, state)[keep]


@dataclass(frozen=True, eq=False)
class _RigidBodyFill:
    """Hold what the kernel needs of a robot's structure, as contiguous arrays."""

    chain_start: Indices
    chain: Indices
    slot: np.ndarray

    @classmethod
    def prepare(cls, robot: RobotModel, target: dict[tuple[int, int], int]) -> "_RigidBodyFill":
        links = robot.links
        chain = np.array([carrier for supports in robot.supports for carrier in supports])
        body = np.repeat(np.arange(len(links)), [len(supports) for supports in robot.supports])
        slot = np.array(
            [
                [target.get((links[carrier].joint - 1, 10 * int(link) + k), -1) for k in range(10)]
                for link, carrier in zip(body, chain, strict=True)
            ]
        )
        return cls(
            chain_start=np.concatenate([[0], np.cumsum([len(supports) for supports in robot.supports])]),
            chain=chain,
            slot=slot,
        )

    def __call__(self, robot: RobotModel, state: MotionState, out: Series) -> None:
        from .kernel import rigid_body_series  # loads numba, and itself from its cache

        links = state.links
        rigid_body_series(
            np.ascontiguousarray(links.position.T),
            np.ascontiguousarray(links.velocity.T),
            np.ascontiguousarray(links.acceleration.T),
            *robot.link_arrays,
            np.asarray(robot.gravity, dtype=float),
            self.chain_start,
            self.chain,
            self.slot,
            out,
        )


def all_columns(model: DynamicModel) -> ColumnPlan:
    """Plan for every parameter of the model."""
    return ColumnPlan(model, tuple(range(len(model.parameters))))


def dense(plan: ColumnPlan, state: MotionState) -> Matrix:
    """Write the observation matrix out in full, samples after samples with the joints innermost.

    For structure, tests and short motions only: a long log's matrix is never stored.
    """
    joints = len(plan.model.robot.joints)
    matrix = np.zeros((len(state.position), joints, len(plan.columns)))
    for (joint, column), row in zip(plan.entries, plan.series(state), strict=True):
        matrix[:, joint, column] = row
    return matrix.reshape(-1, len(plan.columns))
