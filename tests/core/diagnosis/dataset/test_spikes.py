"""A sample that stands out is a spike; what lasts, and noise with heavy tails, is none."""

import numpy as np
import pytest

from tests.core.diagnosis.scenes import ARM_RATE_HZ, look_at_arm, measured_arm
from veritorque.core.diagnosis.dataset.spikes import has_spike, without_spikes

SPAN = (6.0, 6.8)


def look_with(disturbed, noise):
    """Look at the arm with other noise, something of so many N m added at the samples within the span."""
    motion = measured_arm().dataset.motions[0].log.source.rows(0, int(20.0 * ARM_RATE_HZ))
    torque = motion.torque + noise(np.random.default_rng(5), motion.torque.shape)
    inside = (motion.time > SPAN[0]) & (motion.time < SPAN[1])
    torque[inside, 1] += disturbed(np.count_nonzero(inside))
    return look_at_arm(motion.position, torque).dataset


def normal(rng, shape):
    return 0.05 * rng.normal(size=shape)


def heavy(rng, shape):
    return 0.03 * rng.standard_t(3.0, shape)


def one_sample(count):
    return np.where(np.arange(count) == count // 2, 20.0, 0.0)


def push(count):
    return np.full(count, 20.0)


def nothing(count):
    return np.zeros(count)


@pytest.mark.parametrize("noise", [normal, heavy])
@pytest.mark.parametrize(("disturbed", "expected"), [(one_sample, True), (push, False), (nothing, False)])
def test_only_a_sample_that_stands_out_is_a_spike(disturbed, noise, expected):
    assert has_spike(look_with(disturbed, noise).motions[0].log, SPAN) is expected


def test_without_spikes_a_series_is_what_it_was_but_for_their_samples():
    rng = np.random.default_rng(3)
    clean = np.sin(np.arange(2000)[:, None] / 60.0 + np.arange(3)) + normal(rng, (2000, 3))
    spoilt = clean.copy()
    where = rng.choice(np.arange(10, 1990, 10), 20, replace=False)
    spoilt[where, 1] += 500.0
    mended = without_spikes(spoilt)
    np.testing.assert_array_equal(np.delete(mended, where, axis=0), np.delete(clean, where, axis=0))
    assert np.abs(mended - clean).max() < 0.5
