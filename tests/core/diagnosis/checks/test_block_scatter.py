"""Hold the test between blocks to its law: an effect has to be the same throughout, whatever the noise is."""

import numpy as np

from tests.core.diagnosis.scenes import fitter_of, recording, scene_of
from veritorque.core.diagnosis.causes.spring_compensator import SpringCompensator
from veritorque.core.diagnosis.checks.block_scatter import block_log_p
from veritorque.core.diagnosis.search.likelihood_ratio import likelihood_ratio, log_p_of
from veritorque.core.diagnosis.thresholds.checks import BLOCK_SCATTER

JOINT, STIFFNESS, PART_S, LOGS = 2, 1.5, 0.3, 40


def _log_ps(mean: float, scatter: float, seed: int = 1) -> tuple[float, float]:
    """Give log p by the likelihood ratio and between blocks, of a spring that differs from part to part."""
    time, position, torque = recording()
    parts = (time / PART_S).astype(int)
    drawn = np.random.default_rng(seed).normal(size=parts.max() + 1)
    torque[:, JOINT - 1] += (mean + scatter * drawn)[parts] * position[:, JOINT - 1]
    fitter = fitter_of(scene_of(time, position, torque), (SpringCompensator(),))
    none = fitter.fit(())
    (spring,) = (one for one in fitter.candidates if one.site == (JOINT,))
    found = fitter.fit((spring,), none)
    statistic = likelihood_ratio(none, found)
    return log_p_of(fitter, found, 0, statistic), block_log_p(fitter, found, 0, statistic)


def test_a_spring_that_is_one_throughout_is_clear_between_blocks():
    assert max(_log_ps(STIFFNESS, 0.0)) < np.log(1e-6)


def test_springs_that_are_none_on_average_are_clear_to_the_noise_model_alone():
    alone, between = np.array([_log_ps(0.0, STIFFNESS, seed) for seed in range(LOGS)]).T
    assert np.any(alone < np.log(BLOCK_SCATTER.level))
    assert not np.any(between < np.log(BLOCK_SCATTER.level))
