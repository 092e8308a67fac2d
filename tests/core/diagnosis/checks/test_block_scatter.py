"""Hold the test between blocks to its law: an effect has to be the same throughout, whatever the noise is."""

import numpy as np

from tests.core.diagnosis.scenes import fitter_of, recording, scene_of
from veritorque.core.diagnosis.causes.protocol import Cause
from veritorque.core.diagnosis.causes.spring_compensator import SpringCompensator
from veritorque.core.diagnosis.causes.torque_gain_nonlinear import TorqueGainNonlinear
from veritorque.core.diagnosis.checks.between_logs import BetweenLogs
from veritorque.core.diagnosis.checks.block_scatter import block_log_p
from veritorque.core.diagnosis.search.likelihood_ratio import likelihood_ratio, log_p_of
from veritorque.core.diagnosis.thresholds.checks import BLOCK_SCATTER

JOINT, STIFFNESS, PART_S, LOGS = 2, 1.5, 0.3, 40
CUBIC, SLIPPING, INSTANTS_S = 1e-3, 3, (3.0, 4.0, 6.0)


def _log_ps(mean: float, scatter: float, seed: int = 1) -> tuple[float, float]:
    """Give log p by the likelihood ratio and between blocks, of a spring that differs from part to part."""
    time, position, torque = recording()
    parts = (time / PART_S).astype(int)
    drawn = np.random.default_rng(seed).normal(size=parts.max() + 1)
    torque[:, JOINT - 1] += (mean + scatter * drawn)[parts] * position[:, JOINT - 1]
    return _log_ps_of(SpringCompensator(), JOINT, time, position, torque)


def _log_ps_of(cause: Cause, joint: int, *log: np.ndarray) -> tuple[float, float]:
    """Give log p of a cause of one joint by the likelihood ratio and between blocks."""
    fitter = fitter_of(scene_of(*log), (cause,))
    none = fitter.fit(())
    (candidate,) = (one for one in fitter.candidates if one.site == (joint,))
    found = fitter.fit((candidate,), none)
    statistic = likelihood_ratio(none, found)
    equations = BetweenLogs(fitter, found).equations
    return log_p_of(fitter, found, 0, statistic), block_log_p(fitter, found, 0, statistic, equations)


def test_a_spring_that_is_one_throughout_is_clear_between_blocks():
    assert max(_log_ps(STIFFNESS, 0.0)) < np.log(1e-6)


def test_springs_that_are_none_on_average_are_clear_to_the_noise_model_alone():
    alone, between = np.array([_log_ps(0.0, STIFFNESS, seed) for seed in range(LOGS)]).T
    assert np.any(alone < np.log(BLOCK_SCATTER.level))
    assert not np.any(between < np.log(BLOCK_SCATTER.level))


def test_a_cubic_gain_is_clear_between_blocks_and_one_that_a_single_slip_shows_is_not():
    time, position, torque = recording()
    torque[:, JOINT - 1] += CUBIC * torque[:, JOINT - 1] ** 3
    assert max(_log_ps_of(TorqueGainNonlinear(), JOINT, time, position, torque)) < np.log(1e-6)
    between = [_log_ps_of_a_slip(instant)[1] for instant in INSTANTS_S]
    assert not np.any(np.array(between) < np.log(BLOCK_SCATTER.level))


def _log_ps_of_a_slip(instant: float) -> tuple[float, float]:
    """Give log p of a cubic gain where an encoder slips for a moment: the torque has nothing of it."""
    time, position, torque = recording()
    position[:, SLIPPING - 1] += 0.1 * np.exp(-0.5 * ((time - instant) / 0.05) ** 2)
    return _log_ps_of(TorqueGainNonlinear(), SLIPPING, time, position, torque)
