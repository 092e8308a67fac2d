"""Hold every number that decides what is called a conflict, once each, with its unit, meaning and source."""

from dataclasses import dataclass

import numpy as np

from ..numerics.likelihood import UNDECIDED


@dataclass(frozen=True)
class Doubt:
    """Decide whether a fit gives reason to ask at all. All are set by hand."""

    cost: float = 1.05
    """Factor by which the consistency constraint raises the squared error."""
    unexplained: float = 0.1
    """Share of a joint's RMS torque that the model leaves."""


@dataclass(frozen=True)
class Trial:
    """Limit the trials of a hypothesis. All are set by hand unless a source is named."""

    rows: int = 600
    """Instants of all logs together that trials use."""
    judged_every: int = 3
    """Of the fitted blocks, each of this number judges and is not fitted."""
    least_error: float = 1e-4
    """Error relative to the RMS torque below which a joint cannot become better."""
    alike: float = 1e-3
    """Relative difference of all joints' errors up to which two set-ups are the same robot said otherwise."""
    most_corrections: int = 3
    """Conflicts in one set-up."""
    alternatives: int = 3
    """Next best first corrections followed where the best leave a joint in doubt, or lead to more."""
    of_kind: int = 4
    """Hypotheses of one kind that are fitted for this, of those that least squares bounds best."""


@dataclass(frozen=True)
class Decision:
    """Compare two set-ups by their errors on rows that neither was fitted to."""

    undecided: float = UNDECIDED
    """Difference of twice the log-likelihood below which neither of two is preferred. Source: Burnham &
    Anderson, Model Selection (2002), ch. 2."""
    equal: float = 1.0
    """The same below which two predict alike, and the more usual one is applied. Set by hand."""
    failed: float = 0.5
    """Share of a joint's RMS torque. Where the last correction leaves more, none is more likely than not.
    Set by hand, as for the findings of a diagnosis."""
    most_where_unsure: float = 0.5
    """Confidence of a correction there, at most, and where forces that follow positions predict as
    well. Set by hand."""
    scaled: float = 0.25
    """RMS residual over a torque's variation above which no factor on it is known: nearly any would do.
    Source: joints of the four measured robots have up to 0.22."""
    least_share: float = 0.5
    """Share of the mean error before, if not less than a tenth, that corrections may leave to be more likely
    than not. Set by hand."""
    few_values: float = 10.0
    """Independent values of all joints among the rows that judge below which a correction has to leave every
    part out of doubt. Set by hand, as the ten values per unknown of regression; the measured robots have from
    32 in 30 s."""
    parts: int = 3
    """Parts of the samples, one after the other, each of which is predicted from the others. Set by hand."""
    least_in_part: float = 0.1
    """Share of a joint's rows in each part below which joints are taken to move in turn. Set by hand."""
    more_than_scatter: float = 2.92
    """Mean gain in these parts over its standard error above which it is no chance. Source: Student's t with
    two degrees of freedom, one-sided, 95 %; true corrections of four measured robots have from 2.6, mostly
    above 4."""
    left_in_part: float = 0.25
    """Mean error in one of them above which the corrections are not known to be right. Set by hand: true ones
    of the measured robots leave at most 0.15."""
    offset: float = 1.0
    """Torque offset over RMS torque of a joint above which it may stand for gravity after a correction.
    Set by hand: true corrections of eight robots leave at most 0.55."""
    same_rows: float = 0.5
    """Share of the rows in which a torque is judged after a correction that it was judged in before.
    Set by hand. On eight robots whose joints move at once it is 0.97 at least, where these move in turn 0."""
    least_gain: float = 0.15
    """Natural logarithm by which the joints' mean error has to fall: a seventh. Set by hand: on the four
    measured robots as described, no other set-up reaches 0.11."""


@dataclass(frozen=True)
class Mounting:
    """Decide between directions of gravity. All are set by hand."""

    least_angle: float = np.radians(12.0)
    """Angle, rad, from the described direction below which a tilt is a cause with a size, and no conflict;
    and from an axis of the base, or from halfway between two, below which a robot may be mounted along it."""
    apart: float = np.radians(60.0)
    """Angle, rad, between two directions that are refined separately."""


@dataclass(frozen=True)
class Compensation:
    """Search the share of gravity that a compensated torque still holds. All are set by hand."""

    most: float = 0.5
    """Largest share, of either sign; beyond it one is nearer to all of gravity. On five sound robots the
    likeliest is from 0.85 on."""
    steps: int = 41
    """Shares that are compared, 0.025 apart."""


@dataclass(frozen=True)
class TimeBase:
    """Decide whether stamps contradict a measured velocity. All are set by hand unless a source is named."""

    seconds: float = 0.1
    """Seconds over which the velocity is integrated."""
    moving: float = 1e-4
    """Share of the largest joint's squared way from which on a joint moves."""
    follows: float = 0.95
    """Correlation above which a velocity is the positions', but for a factor."""
    alike: float = 0.03
    """Relative difference up to which the factors of joints are one."""
    tolerance: float = 0.05
    """Logarithm of the factor below which it is a filter's or a controller's lag."""
    furthest: float = np.log(6.0)
    """Logarithm beyond which it is a unit's: revolutions per second are 6.28 times less than radians."""


@dataclass(frozen=True)
class TimeOffset:
    """Search an offset between the clocks of positions and torques. All are set by hand."""

    furthest: float = 2.0
    """Seconds either way."""
    steps: int = 50
    """Offsets either way that are tried, 40 ms apart: eight to a period of 3 Hz."""
    least: float = 0.06
    """Seconds below which it is a delay, a cause with a size of up to 50 ms, which is found to some 10 ms."""


@dataclass(frozen=True)
class Length:
    """Search the error of a length. All are set by hand."""

    coarse: tuple[float, ...] = (-0.3, -0.1, 0.0, 0.1, 0.3)
    """Metres that are tried first."""
    promising: float = 0.05
    """Natural logarithm by which the mean error has to fall among these for a length to be refined."""
    tolerance: float = 2e-3
    """Metres to which a length is refined."""
    least: float = 0.03
    """Metres below which an error of a length is a cause with a size, and no conflict."""


@dataclass(frozen=True)
class Ratio:
    """Search the factor of a torque. All are set by hand."""

    coarse: tuple[float, ...] = tuple(2.0**power for power in range(-8, 9) if power)
    """Factors that are tried first, beside a linear estimate; gears of robots reduce by some 20 to 160."""
    promising: float = 0.05
    """Natural logarithm by which the mean error has to fall at one of them for it to be refined."""
    around: float = np.log(5.0)
    """Logarithm of the factor on either side of the first within which it is refined."""
    tolerance: float = 5e-3
    """Logarithm to which a factor is refined."""
    least: float = np.log(2.0)
    """Logarithm below which a factor is a cause with a size, and no conflict."""
    most: float = np.log(300.0)
    """Logarithm beyond which a factor is no gear's: what the fit multiplies so is no torque of this joint."""
    steps: int = 13
    """Factors of a position that are tried first, from the least with which a joint moves to the largest with
    which it can."""
    least_position: float = np.log(1.1)
    """Logarithm below which a factor of a position is no gear's and no unit's."""
    least_span: float = 0.5
    """Radians that one of the joints moves at least with these factors. Gravity is a spring's torque within a
    hundredth where all move less: sin x / x at a quarter."""
    next_to: float = 0.6
    """Logarithm on either side of the best of these factors within which it is refined."""
    apart: float = 1.0
    """Logarithm within which a joint's own factor is looked for about that of all."""
    unknown: float = 0.1
    """Standard deviation of a logarithm above which a log does not tell the factor."""
    curvature_step: float = 0.02
    """Logarithm by which a factor of a position is changed to see how well it is known."""
    fine: float = 2e-4
    """Logarithm to which factors of positions are refined."""
    settled: float = 1e-6
    """Relative change of the bound below which the refinement of several of them ends."""
    gears: tuple[float, float] = (20.0, 200.0)
    """Ratios that gears of robots have."""


@dataclass(frozen=True)
class Unit:
    """Ask for the unit of a position. Set by hand."""

    least_span: float = 0.1
    """Radians that a joint has to move at least in the unit that is tried: what hardly moves fits well."""


@dataclass(frozen=True)
class Zero:
    """Search the angle of a joint's zero. All are set by hand."""

    coarse: tuple[float, ...] = tuple(np.radians((-90.0, -45.0, 0.0, 45.0, 90.0, 180.0)))
    """Angles, rad, that are tried first; quarter turns are hypotheses of their own."""
    promising: float = 0.05
    """Natural logarithm by which the mean error has to fall at one of them for it to be refined."""
    around: float = np.radians(60.0)
    """Angle, rad, on either side of the best within which it is refined."""
    tolerance: float = np.radians(0.2)
    """Angle, rad, to which it is refined."""
    least: float = np.radians(12.0)
    """Angle, rad, about the described zero below which an error is a cause with a size, and no conflict; and
    about a quarter turn, which is then meant."""


@dataclass(frozen=True)
class Linkage:
    """Describe axes of which angles add up. Set by hand."""

    parallel: float = 0.99
    """Cosine of the angle between two axes from which on they are parallel, 8 degrees."""


@dataclass(frozen=True)
class PositionForces:
    """Describe forces that follow positions, as the rival of a correction. All are set by hand."""

    own: int = 5
    """Half waves over the range of a joint, as a function of its own position."""
    neighbour: int = 3
    """The same as a function of a neighbour's."""
    least_span: float = 1e-3
    """Radians or metres: a joint that moves less has no such force."""


@dataclass(frozen=True)
class OtherSignal:
    """Tell a torque from another signal in its place. All are set by hand."""

    copy: float = 0.02
    """RMS of what a motion or another torque, times a factor, leaves of a torque over the torque's variation,
    below which the torque is a copy. A load seldom is one of these; where it is, the model predicts it."""
    predictable: float = 0.2
    """Share of the variance of a torque that can be predicted, below which it is none of this joint."""
    waves: int = 8
    """Half cosine waves of time over all samples, by which slow changes are predicted."""
    ridge: float = 0.01
    """Added to the products of columns of unit size: what a free fit hardly shows, it hardly predicts."""


DOUBT, TRIAL, DECISION, MOUNTING, COMPENSATION = Doubt(), Trial(), Decision(), Mounting(), Compensation()
TIME_BASE, TIME_OFFSET, LENGTH, RATIO, UNIT = TimeBase(), TimeOffset(), Length(), Ratio(), Unit()
POSITION_FORCES, OTHER_SIGNAL, ZERO, LINKAGE = PositionForces(), OtherSignal(), Zero(), Linkage()
