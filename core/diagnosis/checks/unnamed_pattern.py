"""Offer unnamed patterns: a residual may follow one that no listed cause has.

Such a finding has no physical name. It states the joint and the coordinate that the residual follows, and it
prevents that a listed cause is named for lack of a better one. Source: Brynjarsdottir & O'Hagan,
Inverse Problems 30, 2014, for why a free discrepancy may not claim a physical name.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations_with_replacement, product

import numpy as np

from ...arrays import Vector
from ...dynamics.term import Term
from ...dynamics.terms.encoder_error import PositionScale
from ...dynamics.terms.unnamed_pattern import (
    FACTORS,
    PATTERNS,
    GainDrift,
    Numbers,
    OtherTorques,
    SmoothedTorque,
    Trace,
)
from ..causes.protocol import FittedCause, Quantity, Scalars, SearchTraits, Setting
from ..causes.shared.own_joint import OwnJointCause
from ..dataset.dataset import Dataset
from ..thresholds.checks import SMOOTHED, UNNAMED

WAVES = (1.0, 2.0)
SLOWEST, QUICKEST = 0.15, 1.0
"""Rates of repetition in time that are searched, Hz."""
STEP = 0.5
"""Between two rates, in repetitions over the log; refined with `FINER` times finer steps."""
FINER = 8
SWINGS = tuple(float(rate) for rate in np.geomspace(0.7, 4.0, 12))
"""Rates of a swing, Hz."""
LOOPS = tuple(float(rate) for rate in np.geomspace(1.0, 20.0, 12))
"""Bandwidths of a controller's loop, Hz."""
SWITCHES = 16
"""Parts of a log between which friction may switch; refined to the row."""
DRIFT = "drift"
"""A gain of the torque channel that changes with time, whose column is of the model's torque."""
OTHERS, SCALE, SMOOTH = "others", "scale", "smooth"
"""Shares of other joints' torques in the channel, a scale of the joint's positions, and a smoothed torque."""
_NAMES = (*PATTERNS, DRIFT, OTHERS, SCALE, SMOOTH)

_WORDS = {
    "levels": "two levels between which it switches by itself",
    DRIFT: "its own torque times time, as with a gain that drifts",
    OTHERS: "shares of the other joints' torques, as in channels that read each other",
    SCALE: "a scale of its positions, as with a gear ratio that is slightly off",
}
"""What a residual follows that needs no number to say it."""


@dataclass(frozen=True)
class UnnamedPatternCause(OwnJointCause):
    """Offer the unnamed patterns of one joint."""

    id = "unlisted"
    title = "A pattern that no listed cause has"
    units = ()
    coordinate = "time"
    traits = SearchTraits(discrete=("pattern", "number_0", "number_1", "number_2"))

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """List all patterns with their numbers."""
        patterns = _patterns(at.dataset.joints, at.joint, _seconds(at.dataset))
        channels: list[tuple[str, Numbers]] = [(DRIFT, _span(at.dataset)), (SCALE, ())]
        channels += [(SMOOTH, (seconds,)) for seconds in moving_means()]
        channels += [(OTHERS, ())] * (at.dataset.joints > 1)
        return [_scalars(name, numbers) for name, numbers in (*patterns, *_switches(at.dataset), *channels)]

    def loops(self, at: Setting) -> list[Scalars]:
        """List the loops in which the joint may lag behind the logged positions: what a reference leaves."""
        return [_scalars(name, numbers) for name, numbers in _loops(at)]

    def smoothed(self, seconds: float) -> Scalars:
        """Give the scalars of a torque that was smoothed by a moving mean of this length, s."""
        return _scalars(SMOOTH, (seconds,))

    def finer(self, dataset: Dataset, scalars: Scalars) -> list[Scalars]:
        """List numbers around those of a grid point.

        Higher harmonics need a finer rate than the grid's. A switch may be at any row: between it and a wrong
        instant the torque is wrong by all of the change, so that a strong one would fail on held-out rows.
        """
        name, numbers = _read(scalars)
        if name == "clock":
            step = STEP / _seconds(dataset) / FINER
            return [_scalars(name, (numbers[0] + step * shift,)) for shift in range(-FINER, FINER + 1)]
        if name == "loop":
            ratio = LOOPS[1] / LOOPS[0]
            rates = numbers[0] * ratio ** (np.arange(-FINER, FINER + 1) / FINER)
            return [_scalars(name, (float(rate), *numbers[1:])) for rate in rates]
        if name == "friction":
            near = np.abs(dataset.time - numbers[0]) <= _between_switches(dataset)
            return [scalars, *(_scalars(name, (instant,)) for instant in dataset.time[near].tolist())]
        return [scalars]

    def switching(self, instants: Vector) -> Scalars:
        """Give the scalars of a torque that switches between two levels at these instants, s."""
        return _scalars("levels", tuple(instants.tolist()))

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        name, numbers = _read(at.scalars)
        if name == DRIFT:
            return GainDrift(at.joint, at.operating_point, *numbers)
        if name == OTHERS:
            return OtherTorques(at.joint, at.operating_point)
        if name == SMOOTH:
            return SmoothedTorque(at.joint, at.operating_point, *numbers)
        if name == SCALE:
            return PositionScale(at.joint, at.operating_point)
        return Trace(at.joint, name, numbers)

    def admissible(self, solved: FittedCause) -> bool:
        """Tell whether a smoothed torque lacks much of what is quick; other patterns have no size."""
        return _read(solved.scalars)[0] != SMOOTH or float(solved.values[0]) > SMOOTHED.share

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report no numbers: they have no physical meaning."""
        del solved
        return ()

    def statement(self, solved: FittedCause) -> str:
        """Say what the residual follows."""
        return f"The residual of joint {solved.site[0]} follows {_pattern_words(*_read(solved.scalars))}"


def moving_means() -> tuple[float, ...]:
    """List the lengths of a moving mean, s, that may have smoothed a torque."""
    lengths = np.geomspace(UNNAMED.shortest_mean, UNNAMED.longest_mean, UNNAMED.means)
    return tuple(float(seconds) for seconds in lengths)


def mixes_channels(scalars: Scalars) -> bool:
    """Tell whether a pattern is that of torque channels which read each other."""
    return _read(scalars)[0] == OTHERS


@cache
def _patterns(joints: int, own: int, seconds: float) -> tuple[tuple[str, Numbers], ...]:
    others = [joint for joint in range(1, joints + 1) if joint != own]
    out: list[tuple[str, Numbers]] = [
        ("speeds", (float(joint), float(other)))
        for joint, other in combinations_with_replacement(range(1, joints + 1), 2)
    ]
    out += [
        ("angle", (float(joint), wave, float(factor)))
        for joint, wave, factor in product(others, WAVES, range(len(FACTORS)))
    ]
    out += [
        ("clock", (float(rate),)) for rate in np.arange(max(SLOWEST, 2.0 / seconds), QUICKEST, STEP / seconds)
    ]
    out += [("swing", (rate,)) for rate in SWINGS]
    return tuple(out)


def _switches(dataset: Dataset) -> list[tuple[str, Numbers]]:
    """Give the instants at which friction may switch; several logs have none in common."""
    if dataset.log.any():
        return []
    begin, step = float(dataset.time.min()), _between_switches(dataset)
    return [("friction", (begin + step * number,)) for number in range(1, SWITCHES)]


def _loops(at: Setting) -> list[tuple[str, Numbers]]:
    """Give the loops in which a joint may lag behind the logged position: of its own friction and inertia."""
    point, own = at.operating_point, at.joint - 1
    moved = float(np.mean(point.slopes(at.dataset.state, own)[2][:, own])) + point.rotor(at.joint)
    braked = point.coulomb(at.joint) / moved if moved > 0.0 else 0.0
    if braked <= 0.0:
        return []
    return [("loop", (rate, braked, fed)) for rate in LOOPS for fed in (0.0, 1.0)]


def _span(dataset: Dataset) -> Numbers:
    """Give the middle of the time, and half of its range, s."""
    begin, end = float(dataset.time.min()), float(dataset.time.max())
    return 0.5 * (begin + end), 0.5 * (end - begin)


def _between_switches(dataset: Dataset) -> float:
    return float(np.ptp(dataset.time)) / SWITCHES


def _seconds(dataset: Dataset) -> float:
    """Give the length of the longest log, s, no more than a minute: what lasts longer is drift."""
    longest = max(motion.log.duration for motion in dataset.motions)
    return float(np.clip(longest, UNNAMED.least_seconds, UNNAMED.most_seconds))


def _scalars(name: str, numbers: Numbers) -> Scalars:
    return {"pattern": float(_NAMES.index(name))} | {
        f"number_{index}": value for index, value in enumerate(numbers)
    }


def _read(scalars: Scalars) -> tuple[str, Numbers]:
    return _NAMES[int(scalars["pattern"])], tuple(
        scalars[f"number_{index}"] for index in range(len(scalars) - 1)
    )


def _pattern_words(pattern: str, numbers: Numbers) -> str:
    """Say what a residual follows; what has one number needs it alone."""
    if pattern == "speeds":
        first, second = (int(joint) for joint in numbers)
        return (
            f"the square of joint {first}'s speed"
            if first == second
            else (f"the product of the speeds of joints {first} and {second}")
        )
    if pattern == "angle":
        factor = (
            "",
            " times its own speed",
            " with the sign of its own speed",
            " times its own speed squared",
        )
        return (
            f"a wave over joint {int(numbers[0])}'s angle ({numbers[1]:g} per revolution)"
            f"{factor[int(numbers[2])]}"
        )
    if pattern in _WORDS:
        return _WORDS[pattern]
    return {
        "clock": f"a period of {1.0 / numbers[0]:.3g} s, independent of the motion",
        "friction": f"its own friction, which switches at {numbers[0]:.3g} s",
        SMOOTH: "its own torque, smoothed forwards and backwards as by a moving mean over "
        f"{1e3 * numbers[0]:.2g} ms",
        "swing": f"an oscillation at about {numbers[0]:.2g} Hz, independent of the motion",
        "loop": "its dry friction as it would be if the joint lagged behind the logged positions, in a loop "
        f"of about {numbers[0]:.2g} Hz",
    }[pattern]
