"""Test whether noise of the positions may account for a finding.

Columns of delays, filters and springs hold the positions' noise at other instants. A fit that adds them up
makes the noise of the accelerations smaller, which looks like the effect, in every part of the log. Products
of speeds hold the noise's mean square, which looks like a torque that depends on the position. So a finding
must not be much larger or smaller by instruments than by least squares. One that explains no more than such
noise leaves in the residual has to be seen by instruments, at the same size, and must not be of the kinds
that resemble the noise: a controller that answers it puts a little of it into the motion's own band.
Source: Soderstrom, Errors-in-Variables Methods in System Identification (2018), ch. 1 and 6.
"""

from dataclasses import dataclass

import numpy as np

from ..result import Evidence
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Hypothesis
from ..search.likelihood_ratio import likelihood_ratio_by_joint, position_noise_by_joint
from ..thresholds.checks import POSITION_NOISE
from .instruments import Instruments


@dataclass(frozen=True)
class NoiseTest:
    """Hold what a finding explains beside what noise of the positions may account for."""

    statistic: float
    worth: float
    """Likelihood ratio statistic of the finding, and what noise may account for."""
    log_p: float
    log_p_of_difference: float
    """Logs of the p-values, by instruments, of its size and of what least squares finds more or less."""
    change: float
    """Share of its size by which instruments find more or less."""
    alike: bool
    """Whether the noise resembles its columns."""

    @property
    def doubts(self) -> bool:
        """Tell whether noise may make all of it, or makes it much larger or smaller."""
        little = self.statistic < POSITION_NOISE.times * self.worth
        unseen = self.log_p > float(np.log(POSITION_NOISE.level))
        differs = self.log_p_of_difference < float(np.log(POSITION_NOISE.level))
        mostly = differs and self.change > POSITION_NOISE.change
        return mostly or (little and (unseen or differs or self.alike))

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        """State the three."""
        level = float(np.log10(POSITION_NOISE.level))
        return (
            Evidence(
                "Log-likelihood ratio statistic that noise of the positions may account for; a finding of "
                f"less than {POSITION_NOISE.times:g} times as much may be noise",
                "position noise",
                self.worth,
            ),
            Evidence(
                "Logarithm of the p-value by instruments, which are columns of the motion's own band; "
                f"above {level:.0f} the finding may be noise of the positions",
                "log10 p by instruments",
                self.log_p / float(np.log(10.0)),
            ),
            Evidence(
                f"Logarithm of the p-value of the {100.0 * self.change:.0f} % by which instruments find more "
                f"or less; below {level:.0f} noise of the positions adds to the finding or hides some of it",
                "log10 p of the difference",
                self.log_p_of_difference / float(np.log(10.0)),
            ),
        )


def noise_test(
    fitter: HypothesisFitter, without: Hypothesis, instruments: Instruments, index: int, statistic: float
) -> NoiseTest | None:
    """Test a member of the hypothesis that instruments estimate; None where smooth motion hardly shows it.

    Parameters
    ----------
    without
        The hypothesis without the member.
    statistic
        The member's likelihood ratio statistic.
    """
    whole = instruments.whole
    traits = whole.members[index].cause.traits
    if traits.transient or traits.at_peaks:
        return None
    return NoiseTest(
        statistic,
        noise_worth(fitter, without, whole),
        instruments.log_p(index),
        instruments.log_p_of_difference(index),
        instruments.change(index),
        traits.like_position_noise,
    )


def noise_worth(fitter: HypothesisFitter, without: Hypothesis, whole: Hypothesis) -> float:
    """Give the statistic that noise may account for, on the joints that a further member helps."""
    gained = likelihood_ratio_by_joint(without, whole)
    helped = gained > POSITION_NOISE.least_gain * np.sum(np.maximum(gained, 0.0))
    return float(np.sum(position_noise_by_joint(fitter, whole)[helped]))
