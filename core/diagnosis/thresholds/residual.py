"""Hold the numbers that decide how much of a residual is predictable, and how large the noise floor is."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Prediction:
    """Predict a residual on blocks of rows that were not learned from. All are set by hand."""

    blocks: int = 20
    """Blocks that the rows are cut into."""
    quantile: float = 0.975
    """Quantile of Student's law on each side of the interval of the share, which is of 95 %."""
    folds: int = 5
    """Parts of the blocks that are left out in turn."""
    trees: int = 20
    """Regression trees."""
    leaves: int = 6
    """Leaves of a tree."""
    leaf_rows: int = 20
    """Rows of a leaf at least."""
    rate: float = 0.2
    """Factor on what every tree adds."""
    quantiles: int = 63
    """Quantiles of a coordinate at which trees may split."""
    least_rows: int = 200
    """Rows of a joint from which on it is judged."""
    longest_gap: float = 0.5
    """Blocks between rows learned from and rows judged at most: slower noise is no different from drift."""
    uncorrelated: float = 0.1
    """Autocorrelation of the noise below which rows count as independent: the gap otherwise."""


@dataclass(frozen=True)
class Floor:
    """Estimate the noise floor from repeats of the motion and from high frequencies. All are set by hand."""

    over_band: float = 1.5
    """Ratio of the high band's lower end to the cut-off."""
    end: float = 0.45
    """Ratio of the high band's upper end to the rate, below a logger's anti-aliasing filter."""
    least_width: float = 0.8
    """Ratio of the high band's ends from which on there is none."""
    windows: int = 4
    """Windows that a segment must hold."""
    segment_seconds: float = 60.0
    """Seconds of every segment that are used."""
    least_pairs: int = 100
    """Pairs of rows that repeat each other from which on repeats are used."""
    same: float = 0.02
    """Share of its RMS range (speed) by which a joint may deviate a period later."""
    moving: float = 1e-3
    """Share of the largest joint's swing from which on a joint moves."""
    repeat_seconds: float = 2.0
    """Seconds that must repeat."""
    repeat_share: float = 0.3
    """Share of the instants that must repeat."""
    longest_lag: float = 0.8
    """Share of the stretch up to which a period is sought."""
    valley: float = 0.3
    """Mismatch, relative to independent positions, below which a minimum may be a period after a rise."""


PREDICTION, FLOOR = Prediction(), Floor()
