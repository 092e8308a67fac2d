"""Condense conditioned motions to some hundred instants that a set-up can be tried on in milliseconds."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BlockKey, InstantSeries, JointMarks, JointMask, JointSeries, SampleMask
from ..log.columns.assignment import Assignment
from ..log.defects.unsigned import UNSIGNED
from ..signals.condition import Motion
from ..signals.parallel import Tile
from ..signals.state import MotionState
from .thresholds import TRIAL

SERIES = ("position", "velocity", "acceleration", "torque", "direction", "usable", "judged")


@dataclass(frozen=True, eq=False)
class Samples:
    """Hold some instants of all motions, filtered alike."""

    position: JointSeries
    velocity: JointSeries
    acceleration: JointSeries
    torque: JointSeries
    """In rad or m, per s, per s2, N m or N."""
    direction: JointSeries
    """Sign of the velocity, filtered: the sign of a filtered velocity is another thing."""
    usable: JointMask
    """Whether a row of a joint may be used: the joint moves there."""
    measured: JointMarks
    """Whether a joint's torque was measured at all."""
    unsigned: JointMarks
    """Whether a joint's torque is a magnitude in all logs."""
    judged: SampleMask
    """Rows that no trial is fitted to."""
    independent: float
    """Number of independent values of a joint among the rows that are judged: what a model leaves varies as
    the motion does, twice its band per second."""

    def moved(self, assignment: Assignment) -> "Samples":
        """Read the motion as an assignment does; torques stay as measured."""
        position = assignment.position
        speed = 1.0 / assignment.time_factor
        velocity = position.of(self.velocity, rate=True) * speed
        direction = np.sign(position.factor) * self.direction[:, list(position.source)]
        # Of a sum only the sign of the filtered velocity is known.
        direction = np.where(list(map(bool, position.added)), np.sign(velocity), direction)
        return replace(
            self,
            position=position.of(self.position),
            velocity=velocity,
            acceleration=position.of(self.acceleration, rate=True) * speed**2,
            direction=direction,
            usable=self.usable[:, list(position.source)],
        )

    def at(self, wanted: SampleMask) -> "Samples":
        """Keep some of the instants."""
        return replace(self, **{name: getattr(self, name)[wanted] for name in SERIES})

    @property
    def as_measured(self) -> Assignment:
        """Take every channel as it was measured; a torque that was not, for none."""
        joints = len(self.measured)
        own = Assignment.as_measured(joints)
        silent = np.flatnonzero(~self.measured).tolist()
        return replace(own, torque=own.torque.scaled(0.0, *silent))

    @property
    def state(self) -> MotionState:
        """Give the motion as terms of a model take it."""
        return MotionState(self.position, self.velocity, self.acceleration, np.zeros(len(self.position)))


def sampled(motions: tuple[Motion, ...], held_out: frozenset[BlockKey]) -> Samples:
    """Take every n-th decimated sample of the blocks that are not held out."""
    stride = max(1, -(-sum(motion.kept for motion in motions) // TRIAL.rows))
    parts = [
        part for number, motion in enumerate(motions) for part in _taken(motion, number, held_out, stride)
    ]
    series = {name: np.concatenate([part[name] for part in parts]) for name in SERIES}
    measured = ~np.all([motion.segments[0].unmeasured for motion in motions], axis=0)
    # No row of an unmeasured torque is usable. Were it another's, those would be in which the joint moves.
    usable, silent = series["usable"], ~measured
    still = np.max([motion.recipe.still_speed for motion in motions], axis=0)
    moving = np.abs(series["velocity"][:, silent]) > still[silent]
    usable[:, silent] = usable.any(axis=1, keepdims=True) & moving
    seen = sum(motion.log.duration * motion.recipe.motion_band_hz for motion in motions)
    unsigned = np.all([_unsigned(motion) for motion in motions], axis=0)
    count = independent_values(series, seen)
    return Samples(**series, measured=measured, unsigned=unsigned, independent=count)


def _unsigned(motion: Motion) -> JointMarks:
    """Mark the joints whose torque a log shows to be a magnitude."""
    shown = {defect.joint for defect in motion.log.defects if defect.kind == UNSIGNED}
    return np.array([joint + 1 in shown for joint in range(motion.log.joints)])


def independent_values(series: dict[str, np.ndarray], cycles: float) -> float:
    """Count the independent values of a joint that judge: no more than there are rows of it.

    Parameters
    ----------
    cycles
        The motion's band times its duration.
    """
    rows = np.count_nonzero(series["usable"] & series["judged"][:, None], axis=0)
    return max(1.0, min(float(series["judged"].mean()) * 2.0 * cycles, float(rows.mean())))


def _taken(
    motion: Motion, number: int, held_out: frozenset[BlockKey], stride: int
) -> Iterator[dict[str, np.ndarray]]:
    """Give every n-th decimated sample of each block that is fitted; every third of these blocks judges."""
    fitted = [block for block in range(motion.blocks) if (number, block) not in held_out]
    for tile in motion.tiles(fitted):
        taken = np.concatenate([np.arange(kept.start, kept.stop, stride) for _, kept in tile.parts()])
        judged = np.searchsorted(fitted, tile.block[taken]) % TRIAL.judged_every == 1
        yield {
            **{name: values[taken] for name, values in filtered_series(tile).items()},
            "usable": tile.usable[taken],
            "judged": judged,
        }


def filtered_series(tile: Tile) -> dict[str, InstantSeries]:
    """Filter and decimate motion and torque of a tile alike."""
    series = {
        "position": tile.state.position,
        "velocity": tile.state.velocity,
        "acceleration": tile.state.acceleration,
        "torque": tile.torque,
        "direction": tile.state.direction,
    }
    return {name: tile.filtered(np.ascontiguousarray(own.T)).T for name, own in series.items()}
