"""Describe a joint controller as its data sheet does: structure, gains, delay, limit, and the speed it sees.

A ``pd`` controller asks for kp e + kd (dq_ref - dq); a ``cascade`` closes a speed loop inside a position
loop, kv (kp e - dq). With ki they integrate the position error, or the speed loop's error. A cascade whose
speed loop is given the reference's speed besides asks for the same as a pd controller. Source: Siciliano et
al. 2009, ch. 8.
"""

from dataclasses import dataclass
from itertools import chain
from typing import Final, Literal, get_args

import numpy as np

from ...arrays import JointSeries, JointVector
from ...errors import OptionError
from . import control_law as rows
from .control_law import ControlLaw, Inputs

Kind = Literal["pd", "cascade"]
VelocityRule = Literal["measured", "backward", "two_tap", "central", "filtered"]
KINDS: Final = get_args(Kind)
RULES: Final = get_args(VelocityRule)
LONGEST_DELAY: Final = 2
"""Most samples by which a reference may be late or early in a log: a bus and its recorder add one each."""


@dataclass(frozen=True)
class ControllerModel:
    """Hold one controller for all joints, with gains per joint on the scale of its command."""

    kind: Kind
    kp: tuple[float, ...]
    """Per rad or m; of a cascade 1/s."""
    kd: tuple[float, ...]
    """Per rad/s or m/s; of a cascade kv, the speed loop's gain."""
    ki: tuple[float, ...] = ()
    """Per rad s or m s; of a cascade per rad or m, of the speed loop. Empty for none, as below."""
    torque_gain: tuple[float, ...] = ()
    """N m or N per unit of the command; empty where the command is a torque."""
    velocity: VelocityRule = "measured"
    """What stands for the joint's velocity: the recorder's, or that of positions: (q_k - q_k-1) / h, the mean
    of two such, (q_k+1 - q_k-1) / 2 h, or the first through a low pass of first order."""
    cutoff_hz: float | None = None
    """Of that low pass."""
    delay_samples: int = 0
    """Samples by which the reference is late: the command at k is made of the reference at k less these."""
    saturation: tuple[float, ...] = ()
    """Largest command; empty for none."""
    feed_forward: bool = False
    """Whether the torque reference is added."""

    def __post_init__(self) -> None:
        """Refuse controllers that are none."""
        wrong = [
            self.kind not in KINDS or self.velocity not in RULES,
            not _fit(self.kp, self.kd, *filter(len, (self.ki, self.torque_gain, self.saturation))),
            (self.velocity == "filtered") != (self.cutoff_hz is not None and self.cutoff_hz > 0.0),
            abs(self.delay_samples) > LONGEST_DELAY,
        ]
        if any(wrong):
            raise OptionError(
                "the description of the controller is not valid",
                evidence=dict(vars(self)),
                remedy="give a known kind and velocity rule, one number of at least zero per joint in every"
                f" list, a cut-off for a filtered velocity alone, and up to {LONGEST_DELAY} samples of delay",
            )

    def per_joint(self, name: Literal["ki", "torque_gain", "saturation"]) -> JointVector:
        """Give a list of numbers, or what an empty one stands for."""
        without = {"ki": 0.0, "torque_gain": 1.0, "saturation": np.inf}[name]
        return np.array(getattr(self, name) or (without,) * len(self.kp))

    def law(self, step: float) -> ControlLaw:
        """Give the controller to the compiled loop, sampled every `step` (s).

        A central difference is simulated as the velocity itself, which with one step per sample it is.
        """
        gain, kp, kd, ki = (
            self.per_joint("torque_gain"),
            np.array(self.kp),
            np.array(self.kd),
            self.per_joint("ki"),
        )
        cascade = self.kind == "cascade"
        table = np.zeros((rows.LAW_ROWS, len(kp)))
        table[rows.PROPORTIONAL], table[rows.DERIVATIVE] = gain * kp * (kd if cascade else 1.0), gain * kd
        table[rows.INTEGRAL_PLACE] = gain * ki * (kp if cascade else 1.0)
        table[rows.INTEGRAL_RATE] = gain * ki * float(cascade)
        table[rows.LIMIT] = gain * self.per_joint("saturation")
        taps = {"backward": (1.0, -1.0, 0.0), "two_tap": (0.5, 0.0, -0.5), "filtered": (1.0, -1.0, 0.0)}
        if self.velocity in taps:
            pole = pole_of(self.cutoff_hz, step) if self.cutoff_hz else 0.0
            factors = np.array(taps[self.velocity]) * (1.0 - pole) / step
            table[[rows.NOW, rows.LAST, rows.LAST_BUT_ONE]] = factors[:, None]
            table[rows.POLE] = pole
        return ControlLaw(table, sampled=True)

    def inputs(
        self,
        step: float,
        position: JointSeries,
        velocity: JointSeries | None = None,
        torque: JointSeries | None = None,
    ) -> Inputs:
        """Give the compiled loop the references of all samples, every `step` (s): position, velocity, torque.

        The reference of what lies before the first sample or after the last is that of the nearest one.
        """
        wanted = late(position, self.delay_samples)
        speed = speed_wanted(
            self, step, wanted, None if velocity is None else late(velocity, self.delay_samples)
        )
        feed = np.zeros_like(wanted)
        if self.feed_forward and torque is not None:
            feed = late(torque, self.delay_samples)
        return Inputs(feed, wanted, speed)


def _fit(*lists: tuple[float, ...]) -> bool:
    """Tell whether lists of numbers are as long as each other, and no number is negative."""
    lengths = {len(values) for values in lists}
    return len(lengths) == 1 and lengths != {0} and all(0.0 <= value < np.inf for value in chain(*lists))


def pole_of(cutoff_hz: float, step: float) -> float:
    """Give the pole of a sampled low pass of first order."""
    return float(np.exp(-2.0 * np.pi * cutoff_hz * step))


def late(series: JointSeries, samples: int) -> JointSeries:
    """Delay a series, and go on with its ends."""
    numbers = np.clip(np.arange(len(series)) - samples, 0, len(series) - 1)
    return np.asarray(series[numbers])


def seen_velocity(
    rule: VelocityRule, position: JointSeries, step: float, cutoff_hz: float | None = None
) -> JointSeries:
    """Give the velocity that a controller makes of positions; the first and last rows lack neighbours."""
    before = np.diff(position, axis=0, prepend=2.0 * position[:1] - position[1:2]) / step
    if rule == "backward":
        return np.asarray(before)
    if rule == "two_tap":
        return np.asarray(0.5 * (before + late(before, 1)))
    if rule == "central":
        return np.asarray(0.5 * (before + late(before, -1)))
    from scipy.signal import lfilter  # takes a second to load

    pole = pole_of(cutoff_hz or np.inf, step)
    seen, _ = lfilter([1.0 - pole], [1.0, -pole], before, axis=0, zi=pole * before[:1])
    return np.asarray(seen)


def speed_wanted(
    model: ControllerModel, step: float, position: JointSeries, velocity: JointSeries | None
) -> JointSeries:
    """Give the reference of the speed: none in a cascade, else as logged, or made of the position's."""
    if model.kind == "cascade":
        return np.zeros_like(position)
    if velocity is not None:
        return velocity
    rule: VelocityRule = "backward" if model.velocity == "measured" else model.velocity
    return seen_velocity(rule, position, step, model.cutoff_hz)
