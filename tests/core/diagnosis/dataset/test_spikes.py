"""A sample that stands out is a spike; what lasts, and noise with heavy tails, is none."""

import numpy as np
import pytest

from tests.core.diagnosis.scenes import ARM_RATE_HZ, look_at_arm, measured_arm
from veritorque.core.diagnosis.dataset.spikes import has_spike

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
