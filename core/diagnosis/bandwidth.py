"""Limit the bandwidth where position noise dominates the residual.

Position noise grows with the square of frequency on its way to a torque. There the columns themselves are
noisy, every coefficient is biased towards zero at high frequencies (attenuation), and a delay or a filter
would seem to explain it. Source: Fuller, Measurement Error Models (1987), ch. 1.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ..arrays import JointSeries, JointVector, Mask, Matrix, Samples
from ..dynamics.prediction import Prediction
from ..errors import ExcitationError
from ..numerics.distributions import deviation_by_median
from ..robot.model import INERTIAL_SYMBOLS
from .causes.sample_check import disturbance
from .dataset.dataset import Dataset, drowning_width, identification_width
from .regression.ar_noise import ARNoise, run_indices
from .thresholds.dataset import BAND

_SAMPLES = 65536
_POINTS = 5
"""Samples of a fourth difference."""
Fitted = tuple[Dataset, Prediction, tuple[ARNoise, ...]]


def limit_bandwidth(dataset_at: Callable[[float], Fitted]) -> Fitted:
    """Lower the bandwidth until position noise has little share in any joint's residual.

    Parameters
    ----------
    dataset_at
        Gives the data set of a width (bandwidth over the motion's), the prediction of a plain fit to it, and
        the noise of its residual; refuses one of too few rows.
    """
    wide = dataset_at(BAND.over_motion)
    narrowest = min(BAND.narrowest, identification_width(wide[0]))
    fitted = _where_motion_shows(dataset_at, wide, narrowest)
    width = fitted[0].width
    even, even_shares = position_noise_torque(fitted, over_stamps=False)
    for _ in range(BAND.narrowings):
        dataset, share = fitted[0], float(np.max(even_shares))
        if share <= BAND.noise_share or width <= narrowest:
            break
        actual = dataset.band_hz / dataset.motion_band_hz
        factor = (BAND.noise_share / share) ** BAND.noise_power
        asked = max(narrowest, min(width, actual) * min(factor, BAND.most_narrowing))
        fitted = _narrowed(dataset_at, fitted, asked)
        width = fitted[0].width
        narrowest = narrowest if width <= asked else BAND.narrowest
        even, even_shares = position_noise_torque(fitted, over_stamps=False)
    # With scattered stamps a wide band still shows friction, but no delay, filter or spring.
    scattered, scattered_shares = position_noise_torque(fitted, over_stamps=True)
    dataset, operating_point, noise = fitted
    dataset = replace(dataset, position_torque=np.where(scattered_shares > even_shares, scattered, even))
    return dataset, operating_point, noise


def _where_motion_shows(dataset_at: Callable[[float], Fitted], fitted: Fitted, narrowest: float) -> Fitted:
    """Narrow a data set to the band in which noise of the positions does not drown the motion."""
    widest = max(narrowest, drowning_width(fitted[0]))
    return _narrowed(dataset_at, fitted, widest) if fitted[0].width > widest else fitted


def _narrowed(dataset_at: Callable[[float], Fitted], fitted: Fitted, width: float) -> Fitted:
    """Narrow a data set; only to the usual least width, or not at all, where too few rows would be left."""
    try:
        return dataset_at(width)
    except ExcitationError:
        return dataset_at(BAND.narrowest) if fitted[0].width > BAND.narrowest > width else fitted


def position_noise_torque(fitted: Fitted, *, over_stamps: bool) -> tuple[JointSeries, JointVector]:
    """Draw what noise of the positions makes of the torque, N m or N.

    Also gives, per joint, its share of the prewhitened residual's mean square.

    Parameters
    ----------
    over_stamps
        Whether stamps that scatter though the samples do not count as noise of the positions.
    """
    dataset, operating_point, noise = fitted
    size = position_noise(dataset, over_stamps=over_stamps)

    def spoil(position: JointSeries, velocity: JointSeries, rng: np.random.Generator) -> JointSeries:
        del velocity
        return size * rng.normal(size=position.shape)

    run_index = run_indices(~dataset.starts)
    torque = disturbance(dataset, _frictionless(operating_point), spoil)
    shares = []
    for joint, model in enumerate(noise):
        white = model.whitened(torque[:, [joint]], run_index)[dataset.usable[:, joint]]
        shares.append(float(np.sum(white**2)) / max(len(white), 1))
    return torque, np.array(shares)


def _frictionless(operating_point: Prediction) -> Prediction:
    """Leave out terms that jump with the sign of velocity: nuisance columns cover reversals."""
    parameters = operating_point.model.parameters
    inertial = {*INERTIAL_SYMBOLS, "IA", "IAM"}
    kept = np.array([parameter.symbol in inertial for parameter in parameters], dtype=bool)
    return Prediction(
        operating_point.model, np.where(kept, operating_point.standard, 0.0), operating_point.newton_euler
    )


def position_noise(dataset: Dataset, *, over_stamps: bool) -> JointVector:
    """Give the positions' noise per joint, rad or m: the deviation from cubics over the stamps, or the rows.

    Over the stamps, samples beside a few faulty stamps are left out.
    """
    found = []
    for motion in dataset.motions:
        start, stop = max(motion.log.segments, key=lambda segment: segment[1] - segment[0])
        rows = motion.log.source.rows(start, min(stop, start + _SAMPLES))
        time = rows.time if over_stamps else np.arange(len(rows.time), dtype=float)
        beyond = beyond_cubics(time, rows.position)
        if over_stamps:
            beyond = beyond[~few_off(rows.time)]
        found.append(np.sqrt(np.mean(beyond**2, axis=0)))
    return np.asarray(np.max(found, axis=0))


def few_off(stamps: Samples) -> Mask:
    """Mark the groups of five neighbours among which a stamp is faulty; none where faults are not rare.

    Examples
    --------
    >>> stamps = np.arange(1000.0)
    >>> stamps[500] += 0.3
    >>> np.flatnonzero(few_off(stamps))
    array([496, 497, 498, 499, 500])
    """
    scatter = beyond_cubics(np.arange(len(stamps), dtype=float), stamps[:, None])[:, 0]
    usual = deviation_by_median(scatter)
    off = np.abs(scatter) > max(
        BAND.stamp_deviations * usual, BAND.stamp_share * float(np.median(np.diff(stamps)))
    )
    return np.asarray(off & (off.mean() <= BAND.few_stamps))


def beyond_cubics(time: Samples, position: JointSeries) -> Matrix:
    """Give fourth divided differences, scaled so that white noise of a position keeps its size.

    Examples
    --------
    >>> time = np.array([0.0, 1.0, 2.5, 3.0, 4.0, 5.5])
    >>> bool(np.allclose(beyond_cubics(time, time[:, None] ** 3), 0.0))
    True
    """
    stamps = sliding_window_view(time, _POINTS)
    apart = stamps[:, :, None] - stamps[:, None, :] + np.diag(np.full(_POINTS, stamps[0, -1] - stamps[0, 0]))
    weights = 1.0 / np.prod(apart / apart[0, 0, 0], axis=2)
    weights /= np.linalg.norm(weights, axis=1, keepdims=True)
    return np.asarray(np.einsum("np,njp->nj", weights, sliding_window_view(position, _POINTS, axis=0)))
