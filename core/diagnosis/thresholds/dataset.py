"""Hold the numbers that decide which rows and which band the diagnosis works on."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Band:
    """Choose the band of a diagnosis."""

    over_motion: float = 40.0
    """Ratio of the band to the motion's: compliance, ripple and delays lie above the motion. Set by hand."""
    narrowest: float = 10.0
    """The same at least, as wide as the filter of the identification. Set by hand."""
    rate: float = 12.0
    """Ratio of the log's rate to the band at least. Set by hand."""
    position: float = 3.0
    """Ratio of the positions' cut-off to the band. Set by hand."""
    position_over_rate: float = 0.4
    """Ratio of the positions' cut-off to the log's rate at most. Set by hand."""
    rows: float = 2.5
    """Rows per period of the band's edge. Set by hand."""
    states: float = 8.0
    """States per period of the band's edge: nothing above the position filter is left to alias.

    Set by hand.
    """
    order: int = 2
    """Order of the Butterworth filter: effects at a reversal ring for one period, not three. Set by hand."""
    noise_share: float = 0.05
    """Share of a joint's mean square residual that position noise may have. Set by hand."""
    noise_power: float = 0.2
    """Power of the excess by which the band is narrowed.

    Source: the torque of white position noise grows with the square of frequency, its mean square in a band
    with the fifth power of the band's edge.
    """
    least_narrowing: float = 0.5
    """Smallest factor of one narrowing. Set by hand."""
    most_narrowing: float = 0.85
    """Largest factor of one narrowing. Set by hand."""
    narrowings: int = 4
    """Narrowings at most. Set by hand."""
    stamp_deviations: float = 6.0
    """Standard deviations from its neighbours from which a time stamp is off. Set by hand."""
    stamp_share: float = 1e-3
    """Share of the time step below which no stamp is off. Set by hand."""
    few_stamps: float = 0.025
    """Share of all samples up to which the samples beside stamps that are off are left out. Set by hand."""


@dataclass(frozen=True)
class Rows:
    """Choose the rows of a diagnosis."""

    seconds: float = 120.0
    """Seconds of all logs together that are used. Set by hand."""
    stretch_seconds: float = 30.0
    """Seconds of one stretch of a long log. Set by hand."""
    reversal_periods: float = 1.0
    """Periods of the cut-off around a reversal in which rows are set apart. Source: the filter's ringing."""
    still_share: float = 0.01
    """Share of its RMS speed below which a coupled motor rests. Set by hand."""
    shapes: float = 4.0
    """Polynomials of stiction per period of the cut-off, twice what an ideal filter passes. Set by hand."""
    most_shapes: int = 32
    """Polynomials of one stretch at rest; a longer one is cut. Set by hand."""
    spike_order: int = 5
    """Order of the running median that a contact passes and a spike does not. Set by hand."""
    spike_quantile: float = 0.95
    """Quantile of the remainders around a span that says what is usual. Davies & Gather, JASA 88, 1993."""
    spike_ratio: float = 20.0
    """Ratio of a remainder to that quantile from which it is a spike, even in heavy tails. Set by hand."""
    spike_seconds: float = 2.0
    """Seconds on either side of a span that say what is usual. Set by hand."""


BAND, ROWS = Band(), Rows()
