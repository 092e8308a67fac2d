"""Say why a log does not show the spring of a joint: one rule for one joint and for a whole robot.

A spring is reported only where its mode is slow enough for the sampling, the torque carries enough around it,
and the stiffness is known well enough. Each test refuses with its numbers.
"""

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from ..arrays import Samples
from ..numerics.filtering import welch_density

HIGHEST_SHARE: Final = 0.3
"""Mode over the rate above which it is refused: of a faster one a period has three samples, and what holds
between samples decides the answer."""
WORST_PERCENT: Final = 10.0
"""Standard deviation of the stiffness, % of it, above which it is not known. Set by hand."""
LEAST_TORQUE: Final = 0.05
"""Share of the torque's RMS around the mode below which noise makes the torque there. Set by hand."""
AROUND: Final = (0.8, 1.25)
"""The band around antiresonance and mode, as shares of these."""


def reasons_unseen(evidence: Mapping[str, float]) -> Iterator[str]:
    """Say what hides a spring.

    Parameters
    ----------
    evidence
        `natural_hz`, `rate_hz`, `torque_share_percent`, and `stiffness_deviation_percent` where it is known.
    """
    natural, rate, share = (evidence[name] for name in ("natural_hz", "rate_hz", "torque_share_percent"))
    percent = evidence.get("stiffness_deviation_percent", 0.0)
    if natural > HIGHEST_SHARE * rate:
        yield f"the mode at {natural:.3g} Hz is above {HIGHEST_SHARE:g} times the rate of {rate:.4g} Hz"
    if not percent <= WORST_PERCENT:
        yield f"the stiffness is known to {percent:.3g} % only, not to {WORST_PERCENT:g} %"
    if share < 100.0 * LEAST_TORQUE:
        yield f"the torque has {share:.2g} % of its RMS around the mode, less than {100.0 * LEAST_TORQUE:g} %"


def torque_share(torque: Samples, rate_hz: float, low_hz: float, high_hz: float) -> float:
    """Give the RMS of the torque between antiresonance and mode, as a share of its whole RMS."""
    frequency, density = welch_density(torque, rate_hz, min(len(torque), 4096), detrend="constant")
    inside = (frequency >= AROUND[0] * low_hz) & (frequency <= AROUND[1] * high_hz)
    return float(np.sqrt(density[inside].sum() / density.sum()))
