"""Play a log again with the simulated robot in the loop of a joint controller, beside the measured motion.

The drive plays a feed-forward torque, and proportional and derivative gains pull the joints to the reference:
by default the measured torque and the measured motion, so that what the controller adds is what the model
lacks. Every block of the log is played from its own measured start, all blocks at once. The torque that is
reported is what a channel with the model's faults would show.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import takewhile
from typing import Literal

import numpy as np

from ..arrays import BlockKey, JointSeries, JointVector, Samples
from ..errors import OptionError
from ..signals.condition import Motion
from ..signals.state import MotionState, concatenate_states
from .along import channel_torque, memory_torque
from .drive import Drive, Feedback
from .integrate import LONGEST_STEP
from .mechanism import Mechanism
from .rollout import rollout
from .stage import States
from .windows import Stretch, same_clock, stretches

FeedForward = Literal["measured", "model", "none"]


@dataclass(frozen=True, eq=False)
class Gains:
    """Hold proportional and derivative gains per joint, N m/rad and N m s/rad (N/m, N s/m)."""

    stiffness: JointVector
    damping: JointVector


@dataclass(frozen=True)
class ReplayOptions:
    """Choose the feed-forward torque, and the bandwidth (Hz) of gains that are not declared."""

    feed_forward: FeedForward = "measured"
    bandwidth_hz: float = 5.0
    longest_step: float = LONGEST_STEP

    def __post_init__(self) -> None:
        """Refuse controllers that are none."""
        if self.feed_forward not in {"measured", "model", "none"} or not 0.01 <= self.bandwidth_hz <= 100.0:
            raise OptionError(
                "the controller of the replay is not valid",
                evidence={"feed_forward": self.feed_forward, "bandwidth_hz": self.bandwidth_hz},
                remedy="feed forward measured, model or none, with a bandwidth from 0.01 to 100 Hz",
            )


@dataclass(frozen=True, eq=False)
class Replayed:
    """Hold one block played again: measured and simulated motion (rad, m; per s) and torque (N m, N)."""

    key: BlockKey
    time: Samples
    measured: MotionState
    measured_torque: JointSeries
    position: JointSeries
    velocity: JointSeries
    torque: JointSeries


@dataclass(frozen=True, eq=False)
class Replay:
    """Hold all blocks, the gains they were played with, and the RMS errors per joint."""

    blocks: tuple[Replayed, ...]
    gains: Gains
    position_rms: JointVector
    velocity_rms: JointVector
    torque_rms: JointVector


def default_gains(mechanism: Mechanism, position: JointSeries, bandwidth_hz: float) -> Gains:
    """Damp every joint critically at a bandwidth, for the median inertia it sees on its way.

    Without a reference apart from the measured motion no gain can be fitted, since the error is zero.
    """
    inertia = np.median(np.diagonal(mechanism.mass_matrices(position), axis1=1, axis2=2), axis=0)
    rate = 2.0 * np.pi * bandwidth_hz
    return Gains(inertia * rate**2, 2.0 * inertia * rate)


def fitted_gains(
    mechanism: Mechanism, reference: MotionState, measured: MotionState, torque: JointSeries
) -> Gains:
    """Fit gains to a log with a reference: measured torque less the model's along the reference.

    Raises
    ------
    OptionError
        If the reference is the measured motion, which fits any gain, or a fitted gain is negative.
    """
    left = torque - mechanism.torque(reference)
    pairs = []
    for joint in range(mechanism.joints):
        errors = np.column_stack(
            [
                (reference.position - measured.position)[:, joint],
                (reference.velocity - measured.velocity)[:, joint],
            ]
        )
        found, _, rank, _ = np.linalg.lstsq(errors, left[:, joint], rcond=1e-10)
        if rank < 2 or (found < 0.0).any():
            raise OptionError(
                "the joint's gains cannot be fitted",
                evidence={"joint": joint + 1, "rank": int(rank), "fitted": [float(gain) for gain in found]},
                remedy="declare the gains, or give the reference that the controller tracked",
            )
        pairs.append(found)
    stiffness, damping = np.array(pairs).T
    return Gains(stiffness, damping)


def replay(
    mechanism: Mechanism,
    motions: tuple[Motion, ...],
    options: ReplayOptions | None = None,
    *,
    gains: Gains | None = None,
    chosen: frozenset[BlockKey] | None = None,
    progress: Callable[[float], None] | None = None,
) -> Replay:
    """Play the chosen blocks (all by default) again with the measured motion as reference.

    Raises
    ------
    SolverError
        If the simulated motion diverges.
    """
    asked = options or ReplayOptions()
    measured = tuple(stretches(motions, chosen))
    if not measured:
        raise OptionError(
            "there is no block to simulate again",
            evidence={"chosen": sorted(chosen or ())},
            remedy="choose blocks that the logs have",
        )
    if gains is None:
        positions = np.vstack([stretch.state.position[:: stretch.every] for stretch in measured])
        gains = default_gains(mechanism, positions, asked.bandwidth_hz)
    blocks: list[Replayed] = []
    while len(blocks) < len(measured):
        left = measured[len(blocks) :]
        group = list(takewhile(partial(_same_step, left[0]), left))
        blocks += _replay(mechanism, group, gains, asked)
        if progress is not None:
            progress(len(blocks) / len(measured))
    return Replay(tuple(blocks), gains, *_rms_errors(blocks))


def _rms_errors(blocks: Sequence[Replayed]) -> Iterator[JointVector]:
    """Give the RMS errors of position, velocity and torque per joint."""
    errors = (
        [block.position - block.measured.position for block in blocks],
        [block.velocity - block.measured.velocity for block in blocks],
        [block.torque - block.measured_torque for block in blocks],
    )
    return (np.sqrt(np.mean(np.vstack(of_channel) ** 2, axis=0)) for of_channel in errors)


def _same_step(first: Stretch, other: Stretch) -> bool:
    return same_clock(first.step, other.step)


def _replay(mechanism: Mechanism, group: list[Stretch], gains: Gains, asked: ReplayOptions) -> list[Replayed]:
    """Play stretches of one clock side by side; shorter ones wait at their end until the longest is done."""
    past = [memory_torque(mechanism, stretch) for stretch in group]
    shown = [channel_torque(mechanism, stretch) for stretch in group]
    drive = _drive(mechanism, group, gains, asked.feed_forward, past)
    start = concatenate_states([stretch.state.at(slice(1)) for stretch in group])
    moved = rollout(mechanism, States.starting(mechanism, start), drive, longest_step=asked.longest_step)
    return [
        Replayed(
            key=stretch.key,
            time=stretch.time,
            measured=stretch.state,
            measured_torque=stretch.torque,
            position=moved.position[: len(stretch.time), :, lane],
            velocity=moved.velocity[: len(stretch.time), :, lane],
            torque=moved.torque[: len(stretch.time), :, lane] + past[lane] + shown[lane],
        )
        for lane, stretch in enumerate(group)
    ]


def _drive(
    mechanism: Mechanism, group: list[Stretch], gains: Gains, kind: FeedForward, past: list[JointSeries]
) -> Drive:
    """Give the torques that drive stretches side by side: feed-forward less what remains of the past."""
    longest = max(len(stretch.time) for stretch in group)
    position = _pad([stretch.state.position for stretch in group], longest)
    velocity = _pad([stretch.state.velocity for stretch in group], longest)
    forward = (_feed_forward(mechanism, stretch, kind) for stretch in group)
    torque = _pad([full - old for full, old in zip(forward, past, strict=True)], longest)
    return Drive(group[0].step, torque, Feedback(gains.stiffness, gains.damping, position, velocity))


def _feed_forward(mechanism: Mechanism, stretch: Stretch, kind: FeedForward) -> JointSeries:
    """Give the feed-forward torque of the drives, N m or N, without errors of the torque channel."""
    if kind == "none":
        return np.zeros_like(stretch.torque)
    torque = stretch.torque if kind == "measured" else mechanism.torque(stretch.around)[stretch.inside]
    return np.asarray(torque - channel_torque(mechanism, stretch))


def _pad(series: list[JointSeries], longest: int) -> np.ndarray:
    padded = [np.pad(rows, ((0, longest - len(rows)), (0, 0)), mode="edge") for rows in series]
    return np.ascontiguousarray(np.stack(padded, axis=2))
