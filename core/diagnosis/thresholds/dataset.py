"""Hold the numbers that choose the band and the rows of a diagnosis, and find faults of samples."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Band:
    """Choose the band of a diagnosis. All are set by hand unless a source is named."""

    over_motion: float = 20.0
    """Ratio of the band to the motion's: compliance, ripple and delays lie above the motion. Far above it the
    encoder's error goes round the loop: at 40, springs were named on 3 of 8 clean logs of another simulation,
    at 20 on one; at 15 rows are too few to estimate noise from a short log."""
    narrowest: float = 10.0
    """The same at least, as wide as the filter of the identification."""
    rate: float = 12.0
    """Ratio of the log's rate to the band at least."""
    position: float = 3.0
    """Ratio of the positions' cut-off to the band."""
    position_over_rate: float = 0.4
    """Ratio of the positions' cut-off to the log's rate at most."""
    rows: float = 2.5
    """Rows per period of the band's edge."""
    states: float = 8.0
    """States per period of the band's edge: nothing above the position filter is left to alias."""
    smooth_order: int = 4
    """Order of the Butterworth filter that leaves a joint's own band alone."""
    order: int = 2
    """Order of the Butterworth filter: effects at a reversal ring for one period, not three."""
    noise_share: float = 0.05
    """Share of a joint's mean square residual that position noise may have."""
    noise_power: float = 0.2
    """Power of the excess by which the band is narrowed. Source: the torque of white position noise grows
    with the square of frequency, its mean square in a band with the fifth power of the band's edge."""
    most_narrowing: float = 0.85
    """Largest factor of one narrowing."""
    drowned: float = 4.0
    """Ratio of the band to that in which an acceleration holds as much noise as motion, at most. There noise
    has a thousand times the power, which grows with the fifth power of a band, and directions of friction are
    at random. Source: a measured pendulum whose causes are named has a ratio of 2.7."""
    narrowings: int = 10
    """Narrowings at most: enough for a fifth of the widest band, and mostly for the identification's."""
    stamp_deviations: float = 6.0
    """Standard deviations from its neighbours from which a time stamp is off."""
    stamp_share: float = 1e-3
    """Share of the time step below which no stamp is off."""
    few_stamps: float = 0.025
    """Share of all samples up to which the samples beside stamps that are off are left out."""


@dataclass(frozen=True)
class Rows:
    """Choose the rows of a diagnosis. All are set by hand unless a source is named."""

    seconds: float = 120.0
    """Seconds of all logs together that are used, and of every segment that are examined for jitter."""
    per_column: int = 5
    """Rows of a joint per column of its model, on some joint at least; with fewer a fit follows the noise."""
    stretch_seconds: float = 30.0
    """Seconds of one stretch of a long log."""
    settling_periods: float = 3.0
    """Periods of the band's edge at either end of a stretch that are left out: what remembers (springs,
    filters) starts there from rest, and smoothed columns are continued beyond."""
    still_share: float = 0.01
    """Share of its RMS speed below which a coupled motor rests."""
    shapes: float = 4.0
    """Polynomials of stiction per period of the cut-off, twice what an ideal filter passes."""
    most_shapes: int = 32
    """Polynomials of one stretch at rest; a longer one is cut."""
    spike_order: int = 5
    """Order of the running median that a contact passes and a spike does not."""
    spike_quantile: float = 0.95
    """Quantile of the remainders around a span that says what is usual. Davies & Gather, JASA 88, 1993."""
    spike_ratio: float = 20.0
    """Ratio of a remainder to that quantile from which it is a spike, even in heavy tails."""
    spike_seconds: float = 2.0
    """Seconds on either side of a span that say what is usual."""


BAND, ROWS = Band(), Rows()


@dataclass(frozen=True)
class SampleChecks:
    """Decide when a sample check reports a fault. All are set by hand unless a source is named."""

    level: float = 1e-5
    """Probability of a false alarm per check."""
    smooth_over_motion: float = 5.0
    """Band of the smooth motion that is corrupted, over the motion's band."""
    smooth_over_rate: float = 0.2
    """The same at most, over the log's rate."""
    filter_order: int = 5
    """Order of the low-pass filters of the checks."""
    dropped_reach: int = 5
    """Rows over which it is judged whether the robot moved, and how often a channel repeats beside a row."""
    dropped_nearby: int = 200
    """Rows from which the chance is taken that a channel repeats."""
    dropped_rounds: int = 8
    """Rounds in which the chance that all channels repeat follows from each one's among the rows without."""
    dropped_drawn: float = 0.02
    """Share of rows that are drawn at least to measure what repeats add."""
    jitter_band: float = 0.25
    """Share of the log's rate above which positions are compared with velocities."""
    jitter_filters: int = 8
    """Lengths of half the filter that a segment has to have."""
    jitter_agreement: float = 0.5
    """Ratio of the variance from products of joints to that from their squares from which joints agree."""
    jitter_share: float = 1e-3
    """Share of some joint's residual that jitter has to account for: rounding scatters, too."""
    jitter_held: float = 0.4
    """Share of the motion in which all positions repeat, from which rows are not the samples. Set by hand: of
    samples that are half as many as rows it is a half."""
    jitter_block: int = 32
    """Rows whose products are summed before their scatter is taken."""
    dead_passages: int = 3
    """Stretches of exact zeros while a joint moves from which a dead zone is looked for."""
    dead_nearby: float = 1.0
    """Nonzero torques per zero that have to be there: fewer say nothing of how dense they are."""
    dead_over_others: float = 5.0
    """Ratio of zeros to the most frequent other value among as many torques next to zero. A channel that cuts
    off what is below its step has twice as many zeros."""
    dead_flank: float = 0.5
    """Share of the median torque that the smaller torque beside a stretch of zeros has to be below."""
    dead_flanks: float = 0.9
    """Share of the stretches of which it has to be: lost samples are anywhere."""
    dead_gap: float = 0.5
    """Share of the width without values beside zero from which larger torques are taken to be unchanged."""
    dead_clearness: float = 3.0
    """Deviations from zero from which on torques outside of a dead zone are too small by the model."""
    cut_levels: int = 3
    """Sizes from which a channel is taken to have steps, zero among them."""
    cut_exactness: float = 0.1
    """Share of a step that a value may lie off its multiples: a log holds rounded numbers."""
    cut_zeros: float = 1.4
    """Ratio of zeros to the values one step off, on average, from which a channel may cut off what is below
    its step: rounding gives 1 and cutting 2."""
    cut_scatter: float = 1.2247
    """Deviation of that ratio over one passage through zero and two beside it, each of which lasts as long as
    chance has it, the square root of 1 + 1/2. Source: the exponential law."""
    cut_chance: float = 1e-3
    """Probability of so many zeros by rounding, below which torques may be cut off though no model tells."""
    cut_least: float = 0.5
    """Share of half a step by which torques have to be too small, or less than as much again too small."""
    rounding_share: float = 0.6
    """Share of a joint's residual that rounding has to account for. Good encoders account for a half."""
    rounding_of_torque: float = 0.006
    """Share of a joint's torque that rounding has to account for; below, it is negligible."""
    coarser: float = 5.0
    """Ratio of an encoder's step to the other joints' median step from which it stands out."""
    coarse_share: float = 0.05
    """Share of a residual from which an encoder that stands out is reported."""
    coarse_of_torque: float = 0.02
    """Share of a torque from which an encoder that stands out is reported."""


SAMPLE_CHECKS = SampleChecks()
