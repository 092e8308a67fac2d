"""Check raw samples for faults that no torque term can correct: stamps, rows and resolution.

The share of the residual that a fault accounts for is simulated: the fault is applied to the smooth motion,
and its error passes position filter, differentiation and predicted torque as the real one did.
Source: Kay, Fundamentals of Statistical Signal Processing I (1993), ch. 7, for the estimates.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import ClassVar, Protocol, runtime_checkable

import numpy as np
from scipy.interpolate import CubicSpline

from ...arrays import JointSeries, JointVector
from ...dynamics.prediction import Prediction
from ...dynamics.terms.effect import step_of
from ...numerics.filtering import convolved
from ...signals.condition import Motion
from ...signals.derivative import differentiate_throughout
from ...signals.resample import without_spikes
from ...signals.state import MotionState
from ...signals.zero_phase import kernel
from ..dataset.dataset import Dataset
from ..dataset.stretch import Stretch
from ..regression.innovation_covariance import fitted_rows, torque_residual
from ..thresholds.dataset import SAMPLE_CHECKS
from .protocol import Cure, Quantity, Site

Corruption = Callable[[JointSeries, JointSeries, np.random.Generator], JointSeries]
"""Take smooth positions and velocities at the log's rate, give the errors of position."""


@dataclass(frozen=True, eq=False)
class SampleFinding:
    """Hold the result of a sample check."""

    site: Site
    quantities: tuple[Quantity, ...]
    statement: str
    statistic: float
    p_value: float
    """The test statistic, and the probability that it is reached by chance."""
    residual_share: JointVector
    """Per joint, the share of the residual's mean square that the fault accounts for."""


@runtime_checkable
class SampleCheck(Protocol):
    """Define a candidate fault of the samples; the attributes are those of `Cause`."""

    id: ClassVar[str]
    title: ClassVar[str]
    experiment: ClassVar[str]
    units: ClassVar[tuple[tuple[str, str], ...]]
    cure: ClassVar[Cure] = "signal"
    beyond_repair: ClassVar[str]
    """Why no log can be corrected for it, in a sentence."""

    def examine(self, dataset: Dataset, operating_point: Prediction) -> tuple[SampleFinding, ...]:
        """Search the logs for it."""


def residual_share(dataset: Dataset, operating_point: Prediction, corrupt: Corruption) -> JointVector:
    """Corrupt the smooth motion and give, per joint, the added mean square over the residual's."""
    return share_of_residual(dataset, operating_point, disturbance(dataset, operating_point, corrupt))


def share_of_residual(dataset: Dataset, operating_point: Prediction, gained: JointSeries) -> JointVector:
    """Give, per joint, the share of the residual's mean square that a disturbance has: all of it at most."""
    return np.asarray(np.minimum(over_residual(dataset, operating_point, gained), 1.0))


def followed_share(dataset: Dataset, operating_point: Prediction, added: JointSeries) -> JointVector:
    """Give, per joint, the share of the residual's mean square that follows a known disturbance.

    A fit takes up a part of it, so that a disturbance may be larger than the residual.
    """
    left, mask = torque_residual(dataset, operating_point), fitted_rows(dataset)
    products = (left * added * mask).sum(axis=0)
    sizes = (left**2 * mask).sum(axis=0) * (added**2 * mask).sum(axis=0)
    return np.asarray(np.maximum(products, 0.0) ** 2 / np.maximum(sizes, 1e-300))


def over_residual(dataset: Dataset, operating_point: Prediction, gained: JointSeries) -> JointVector:
    """Give, per joint, the mean square of a disturbance over the residual's."""
    left, mask = torque_residual(dataset, operating_point), fitted_rows(dataset)
    had = np.maximum((left**2 * mask).sum(axis=0), 1e-300)
    return np.asarray((gained**2 * mask).sum(axis=0) / had)


def disturbance(dataset: Dataset, operating_point: Prediction, corrupt: Corruption) -> JointSeries:
    """Corrupt the smooth motion and give what that adds to the torque at the data set's rows, N m or N."""
    rng = np.random.default_rng(0)
    gained = np.zeros_like(dataset.torque)
    for stretch in dataset.stretches:
        state, motion = stretch.state, dataset.motions[dataset.log[stretch.rows.start]]
        corrupted = _corrupted(state, motion, corrupt, rng)
        gained[stretch.rows] = _change(stretch, operating_point, corrupted)
    return gained


def _change(stretch: Stretch, operating_point: Prediction, corrupted: MotionState) -> JointSeries:
    change = operating_point.torque(corrupted) - operating_point.torque(stretch.state)
    return stretch.filtered(change.T).T


def _corrupted(
    state: MotionState, motion: Motion, corrupt: Corruption, rng: np.random.Generator
) -> MotionState:
    rate_hz, recipe = motion.log.rate_hz, motion.recipe
    thin = max(1, round(step_of(state) * rate_hz))
    band = SAMPLE_CHECKS.smooth_over_motion * recipe.motion_band_hz
    smooth = _smooth(state, thin, min(band, SAMPLE_CHECKS.smooth_over_rate * rate_hz), rate_hz)
    corrupted = smooth + corrupt(smooth, differentiate_throughout(smooth, rate_hz), rng)
    error = without_spikes(corrupted, recipe.median_order) - without_spikes(smooth, recipe.median_order)
    off = error.any(axis=0)  # most checks corrupt one joint
    if off.any():
        error[:, off] = _filtered(error[:, off], recipe.position_cutoff_hz, rate_hz)
    rate = differentiate_throughout(error, rate_hz)
    second = differentiate_throughout(rate, rate_hz)
    return replace(
        state,
        position=state.position + error[::thin],
        velocity=state.velocity + rate[::thin],
        acceleration=state.acceleration + second[::thin],
    )


@lru_cache(maxsize=8)
def _smooth(state: MotionState, thin: int, band_hz: float, rate_hz: float) -> JointSeries:
    """Give the motion at the log's rate without its error, for every check to corrupt."""
    count = len(state.position)
    fine = np.arange((count - 1) * thin + 1) / thin
    measured = state.position if thin == 1 else CubicSpline(np.arange(count), state.position)(fine)
    smooth = _filtered(measured, band_hz, rate_hz)
    smooth.setflags(write=False)
    return smooth


def _filtered(values: JointSeries, cutoff_hz: float, rate_hz: float) -> JointSeries:
    low_pass = kernel(cutoff_hz, rate_hz, SAMPLE_CHECKS.filter_order)
    reach = len(low_pass) // 2
    padded = np.pad(values, ((reach, reach), (0, 0)), mode="edge")
    return convolved(padded, low_pass)
