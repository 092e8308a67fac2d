"""Carry the motion of all joints at the same instants: what every torque effect is computed from."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Beside, FrictionShares, Indices, JointSeries, Samples


@dataclass(frozen=True, eq=False)
class MotionState:
    """Carry position (rad or m), velocity (per s) and acceleration (per s2) of all joints."""

    position: JointSeries
    velocity: JointSeries
    acceleration: JointSeries
    time: Samples | None = None
    """The instants, s, on the log's own clock; None where only the configuration matters."""
    temperature: JointSeries | None = None
    """Temperature of every joint, degC; None where none was logged."""
    log: Samples | None = None
    """Number of the log, from 0, that each instant belongs to; None where motions are of no log."""
    friction_share: FrictionShares | None = None
    """Dry friction as a share of its level, from -1 to 1: of the joints first, then of declared couplings.
    A simulation knows it also where friction holds, and it stands in the place of the velocity's sign; None
    where only the velocity is known."""
    stamped_velocity: Beside | None = None
    behind: Samples | None = None
    """Where torques were interpolated: the velocities at the stamps before and behind each instant, and how
    far it lies from the first to the second, from 0 to 1. None where torques are as measured."""
    link_position: JointSeries | None = None
    link_velocity: JointSeries | None = None
    link_acceleration: JointSeries | None = None
    """Motion of the links where springs lie between motors and links; None where links move as motors do."""

    @property
    def links(self) -> "MotionState":
        """Give the motion of the links."""
        if self.link_position is None or self.link_velocity is None or self.link_acceleration is None:
            return self
        return MotionState(self.link_position, self.link_velocity, self.link_acceleration, self.time)

    def in_log(self, number: int) -> Samples:
        """Give 1 at instants of a log (from 0), 0 elsewhere."""
        return np.zeros(len(self.position)) if self.log is None else np.where(self.log == number, 1.0, 0.0)

    @property
    def direction(self) -> JointSeries:
        """Give the signs of the velocities as the torque has them (see `by_stamps`)."""
        return self.by_stamps(np.sign)

    def by_stamps(self, made: Callable[[JointSeries], np.ndarray]) -> np.ndarray:
        """Give what follows from the velocity, with jumps, as the torque has it.

        A line between two samples of a torque passes through a jump gradually. So where torques were
        interpolated, what jumps is taken at the stamps and interpolated in the same way.
        """
        if self.stamped_velocity is None or self.behind is None:
            return made(self.velocity)
        first, second = (made(self.stamped_velocity[..., side]) for side in (0, 1))
        share = self.behind.reshape(-1, *(1,) * (first.ndim - 1))
        return np.asarray((1.0 - share) * first + share * second)

    def at(self, rows: slice | Indices) -> "MotionState":
        """Take some rows of the motion."""
        return MotionState(**{name: part[rows] for name, part in vars(self).items() if part is not None})


def concatenate_states(states: Sequence[MotionState]) -> MotionState:
    """Put rows of motions one after the other; what one of them lacks is left out of all."""
    parts = {name: [getattr(state, name) for state in states] for name in vars(states[0])}
    return MotionState(
        **{name: np.concatenate(rows) for name, rows in parts.items() if all(row is not None for row in rows)}
    )
