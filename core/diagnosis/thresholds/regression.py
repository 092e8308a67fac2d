"""Hold the numbers that decide how noise is modelled and which columns count."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Noise:
    """Decide how a joint's noise is modelled. All are set by hand unless a source is named."""

    order: int = 12
    """Highest order of the autoregression."""
    rows_per_order: int = 30
    """Rows per order of the autoregression at least."""
    rows_per_reflection: int = 10
    """Rows that one reflection coefficient is estimated from at least."""
    shrinkage: float = 2e-3
    """Share by which correlations with the past are reduced, so that the memory of the noise is finite."""
    least_freedom: float = 0.1
    """Share of the rows that a fit leaves free at least, when the variance is corrected for its
    parameters."""
    rounds: int = 3
    """Rounds in which the noise is estimated again."""
    trial_rounds: int = 2
    """The same for a candidate on trial."""
    settled: float = 0.1
    """Rise of a joint's log-likelihood below which the noise is kept."""
    absorbed: float = 1.3
    """Ratio of the RMS residual to that of an ordinary fit from which the noise model absorbs effects."""


@dataclass(frozen=True)
class Columns:
    """Decide which columns count as evidence."""

    least_clear: float = 1e-6
    """Share of a column's square that the others leave below which it is no evidence. Set by hand."""
    least_size: float = 1e-6
    """Norm of a white column below which it is rounding errors: a million units of its parameter would not
    change the torque by a standard deviation of the noise. Set by hand."""


NOISE, COLUMNS = Noise(), Columns()
