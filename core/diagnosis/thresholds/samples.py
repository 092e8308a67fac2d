"""Hold the numbers that decide whether the samples of a log are faulty."""

from dataclasses import dataclass


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
    """Rows over which it is judged whether the robot moved."""
    jitter_seconds: float = 120.0
    """Seconds of every segment that are examined for jitter."""
    jitter_band: float = 0.25
    """Share of the log's rate above which positions are compared with velocities."""
    jitter_filters: int = 8
    """Lengths of half the filter that a segment has to have."""
    jitter_agreement: float = 0.5
    """Ratio of the variance from products of joints to that from their squares from which joints agree."""
    jitter_share: float = 1e-3
    """Share of some joint's residual that jitter has to account for: rounding scatters, too."""
    jitter_block: int = 32
    """Rows whose products are summed before their scatter is taken."""
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
    increment_by_chance: float = 0.2
    """Probability that one increment lies within a tenth of a whole number of steps. Two tenths of a step."""


SAMPLE_CHECKS = SampleChecks()
