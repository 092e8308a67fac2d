"""Decide how signals are conditioned, with cut-offs read off the motion's own spectrum.

Nothing here uses the torque: a cut-off chosen to make the residual small would be tuned on what it is
judged by.
"""

from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np

from ..arrays import JointMarks, JointVector, Mask
from ..errors import LogError, OptionError
from ..log.gaps import naming_gaps
from ..log.model import JointLog
from ..robot.joint_units import largest_of_kind
from .noise_band import ATTENUATION, OUTWEIGHED, noise_cutoff
from .survey import Survey, survey_of
from .zero_phase import HIGHEST_ORDER

PARALLEL_OVER_MOTION = 10.0
"""The parallel filter passes ten times the motion's band. Products of the joints' motions lie above each of
them."""
LEAST_OVER_MOTION = 0.5
"""However noisy the positions are, half of the motion's band is passed: below it most motion is lost."""
KEPT_APART = 0.4
"""Kept samples are so much of a period of the cut-off apart."""
FEWEST_KEPT = 100
"""However noisy the positions are, so many samples are kept, where ten times the motion's band allows it.
With fewer, a log may have fewer equations than parameters. Set by hand: five in each of twenty blocks."""
POSITION_OVER_PARALLEL = 5.0
"""Positions keep a band five times wider. So that their filter does not bend what the parallel filter
passes."""
STILL_SHARE = 0.01
"""A joint stands when it is slower than this share of its RMS speed."""
TREMBLE_SHARE = 0.01
"""A joint slower than this share of the fastest one of its kind (turning or sliding) only trembles. Its
spectrum is its encoder's."""
HELD_OVER_RMS = 10.0
"""Where all joints of a kind are held, they stand at so many times their RMS speed: all the time."""
LOWEST_SHARE = 0.05
"""A cut-off below this share of the motion's band leaves no motion, and its kernel outgrows any log."""
FEWEST_ROWS, SHORTEST_SECONDS = 16, 1.0
"""A stretch of fewer rows or seconds is not differentiated: the filters' reach is all of it."""
SLOWEST_SHARE = 0.5
"""A stretch sampled at less than this share of the log's rate is not used: all share one filter, and it would
halve the band of the others."""


@dataclass(frozen=True)
class FilterOptions:
    """Ask for a recipe; None leaves the choice to the motion.

    `cutoff_hz` and `order` are the parallel filter's; `position_cutoff_hz` is that of the filter on q (same
    order).
    """

    median_order: int = 5
    cutoff_hz: float | None = None
    position_cutoff_hz: float | None = None
    order: int = 5
    decimation: int | None = None

    def __post_init__(self) -> None:
        """Refuse what no log could be filtered with."""
        counts = {
            "median_order": (self.median_order, range(1, 32, 2)),
            "decimation": (1 if self.decimation is None else self.decimation, range(1, 1001)),
            "order": (self.order, range(1, HIGHEST_ORDER + 1)),
        }
        wrong: dict[str, float] = {
            name: count for name, (count, allowed) in counts.items() if count not in allowed
        }
        wrong |= {name: value for name, value in self.cutoffs_hz.items() if value <= 0.0}
        if wrong:
            raise OptionError(
                "the filter options are not valid",
                evidence=wrong,
                remedy="give cut-offs above 0 Hz, an odd median_order from 1 to 31, an order from 1 to "
                f"{HIGHEST_ORDER} and a decimation from 1 to 1000",
            )

    @property
    def cutoffs_hz(self) -> dict[str, float]:
        """Give the cut-offs that were asked for, by name."""
        both = {"cutoff_hz": self.cutoff_hz, "position_cutoff_hz": self.position_cutoff_hz}
        return {name: value for name, value in both.items() if value is not None}

    def check_log(self, rate_hz: float, duration: float) -> None:
        """Refuse cut-offs that no log of this rate and duration (s) can be filtered with, whatever moves.

        Raises
        ------
        OptionError
            If a cut-off is not below half the rate, or its period is longer than the log.
        """
        nyquist, slowest = 0.5 * rate_hz, 1.0 / max(duration, 1.0 / rate_hz)
        for name, value in self.cutoffs_hz.items():
            if not slowest < value < nyquist:
                raise OptionError(
                    f"{name} does not fit the log's rate or its duration",
                    evidence={name: value, "rate_hz": rate_hz, "duration_s": duration},
                    remedy=f"give a cut-off above {slowest:.3g} Hz and below {nyquist:.6g} Hz",
                )


@dataclass(frozen=True, eq=False)
class Recipe:
    """Fix every number of the chain for one log."""

    median_order: int
    position_cutoff_hz: float
    cutoff_hz: float
    order: int
    decimation: int
    motion_band_hz: float
    """Frequency below which the joints' velocities hold 99.5 % of their power, the largest over the
    joints."""
    joint_bands_hz: JointVector
    """The same of every joint; that of the log for those that stand."""
    rms_speed: JointVector
    still_speed: JointVector
    """Speed per joint, and the speed below which it counts as standing (rad/s or m/s)."""
    position_noise: JointVector
    """RMS of the white noise of every joint's positions (rad or m)."""
    outweighed_hz: float
    """Frequency up to which the joints' accelerations hold more motion than noise of the positions."""
    reason: str
    """Why these cut-offs, in one sentence."""

    @property
    def held(self) -> JointMarks:
        """Mark the joints that stand all the time: what their positions show beside it is noise."""
        return np.asarray(self.rms_speed <= self.still_speed)


# What was read off a log is not read off it again.
_CHOSEN: WeakKeyDictionary[JointLog, dict[tuple[FilterOptions, bytes], Recipe]] = WeakKeyDictionary()


def choose_recipe(log: JointLog, options: FilterOptions, prismatic: Mask | None = None) -> Recipe:
    """Read the motion's band off the log and settle the cut-offs, the decimation and the standstill speeds.

    Parameters
    ----------
    prismatic
        Which joints slide; none by default.

    Raises
    ------
    OptionError
        If a given cut-off does not fit the log's rate or motion.
    LogError
        If no stretch between gaps is long enough to be differentiated.
    """
    sliding = np.zeros(log.joints, dtype=bool) if prismatic is None else prismatic
    known, asked = _CHOSEN.setdefault(log, {}), (options, sliding.tobytes())
    return known[asked] if asked in known else known.setdefault(asked, _choose(log, options, sliding))


def _choose(log: JointLog, options: FilterOptions, prismatic: Mask) -> Recipe:
    rates = segment_rates(log)
    if not rates:
        with naming_gaps([log]):
            raise LogError(
                "no stretch of the log between its gaps is long enough to be differentiated",
                evidence={
                    "longest_samples": max(stop - start for start, stop in log.segments),
                    "log": log.name,
                },
                remedy="record at least one second without gaps",
            )
    rate, survey = log.rate_hz, survey_of(log, options.median_order)
    bands, speeds, slowest = survey.bands, survey.speeds, min(survey.slowest, *rates)
    still_speed = _still_speed(survey, prismatic)
    moving = bands[speeds > still_speed]
    band = float(moving.max()) if len(moving) else 1.0
    nyquist = 0.5 * min(rate, slowest)
    highest = min(0.4 * rate, 0.9 * nyquist)
    quiet = max(noise_cutoff(survey.positions, rate, band, speeds > still_speed), LEAST_OVER_MOTION * band)
    outweighed = quiet * (OUTWEIGHED / ATTENUATION) ** 0.2
    wanted, why = _parallel_cutoff(band, quiet, outweighed, log.samples / rate)
    cutoff = _or_default(options.cutoff_hz, min(wanted, highest / 2.0))
    position = _or_default(options.position_cutoff_hz, min(POSITION_OVER_PARALLEL * cutoff, highest))
    for name, value in (("cutoff_hz", cutoff), ("position_cutoff_hz", position)):
        if not LOWEST_SHARE * band < value < nyquist:
            raise OptionError(
                f"{name} does not fit the log's rate or its motion",
                evidence={name: value, "rate_hz": 2.0 * nyquist, "motion_band_hz": band},
                remedy=f"give a cut-off above {LOWEST_SHARE * band:.3g} Hz and below {nyquist:.6g} Hz",
            )
    decimation = options.decimation or max(1, int(KEPT_APART * rate / cutoff))
    reason = why if options.cutoff_hz is None else "given"
    return Recipe(
        median_order=options.median_order,
        position_cutoff_hz=position,
        cutoff_hz=cutoff,
        order=options.order,
        decimation=decimation,
        motion_band_hz=band,
        joint_bands_hz=np.where(speeds > still_speed, bands, band),
        rms_speed=speeds,
        still_speed=still_speed,
        position_noise=survey.noise,
        outweighed_hz=outweighed,
        reason=(
            f"parallel filter at {cutoff:.3g} Hz ({reason}), positions at {position:.3g} Hz,"
            f" one sample in {decimation} kept"
        ),
    )


def segment_rates(log: JointLog) -> list[float]:
    """Give the mean rates (Hz) of the stretches between gaps that can be differentiated.

    Those of less than `SLOWEST_SHARE` of the log's rate are not among them.
    """
    rates = []
    for start, stop in log.segments:
        stamps = [float(log.source.rows(row, row + 1).time[0]) for row in (start, stop - 1)]
        if is_usable(stop - start, stamps[-1] - stamps[0], log.rate_hz):
            rates.append((stop - start - 1) / (stamps[-1] - stamps[0]))
    return rates


def is_usable(rows: int, seconds: float, rate_hz: float) -> bool:
    """Tell whether a stretch is long enough and sampled fast enough to be differentiated with the others.

    Examples
    --------
    >>> is_usable(100, 3.0, 30.0), is_usable(100, 10.0, 30.0), is_usable(10, 0.3, 30.0)
    (True, False, False)
    """
    enough = rows >= FEWEST_ROWS and seconds >= SHORTEST_SECONDS
    return enough and rows - 1 >= SLOWEST_SHARE * rate_hz * seconds


def _still_speed(survey: Survey, prismatic: Mask) -> JointVector:
    """Give the speed below which each joint stands, such that a joint held by its drive stands throughout.

    Where joints of both kinds are logged, a kind of which every joint shows noise only is held.
    """
    speeds = survey.speeds
    fastest = largest_of_kind(speeds, prismatic)
    still = np.where(speeds <= TREMBLE_SHARE * fastest, TREMBLE_SHARE * fastest, STILL_SHARE * speeds)
    for kind in (prismatic, ~prismatic):
        if kind.any() and not kind.all() and survey.noisy[kind].all():
            still[kind] = HELD_OVER_RMS * speeds[kind]
    return still


def _parallel_cutoff(band: float, quiet: float, outweighed: float, seconds: float) -> tuple[float, str]:
    """Choose the parallel filter's cut-off (Hz) by the motion's band and the noise of positions; say why.

    Parameters
    ----------
    seconds
        How long the log records, without its gaps.
    """
    wide, fewest = PARALLEL_OVER_MOTION * band, KEPT_APART * FEWEST_KEPT / seconds
    if wide <= outweighed:
        return wide, f"{PARALLEL_OVER_MOTION:g} times the motion's band of {band:.3g} Hz"
    noisy = (
        f"above {quiet:.3g} Hz the noise of positions would attenuate what is fitted by more than"
        f" {100.0 * ATTENUATION:g} %"
    )
    if fewest <= quiet:
        return quiet, f"{noisy}; the motion's band is {band:.3g} Hz"
    limit = f"{PARALLEL_OVER_MOTION:g} times the motion's band of {band:.3g} Hz"
    return min(fewest, wide), f"the least that keeps {FEWEST_KEPT} samples, up to {limit}; {noisy}"


def _or_default(asked: float | None, chosen: float) -> float:
    return chosen if asked is None else asked
