"""What happens once is noticed whatever its shape; noise, spikes and motion that comes and goes are not."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.diagnosis.made_up import JOINT, nothing_found, on_joint
from tests.core.diagnosis.processes import SLOW, WAVY, WHITE, drawn
from tests.core.diagnosis.scenes import fitter_of, measured_arm
from veritorque.core.diagnosis.checks.bursts import burst
from veritorque.core.diagnosis.search.residuals import residual

BEGIN, END = 6.0, 6.8


def seen(effect=None, seed=6):
    fitter = fitter_of(measured_arm(effect, seed=seed), ())
    return burst(fitter.dataset, residual(fitter, nothing_found(fitter)))


@pytest.mark.parametrize("height", [1.0, -3.0])
def test_a_push_without_a_shape_is_seen_on_its_joint_and_when_it_was(height):
    found = seen(on_joint(lambda state: height * ((state.time > BEGIN) & (state.time < END))))
    assert found.joint == JOINT
    when = float(found.statement.split(" at ")[1].split(" s")[0])
    assert BEGIN - 0.2 < when < END + 0.2
    assert found.log10_p < -6.0


def test_single_spikes_are_no_burst():
    def spikes(state):
        return 20.0 * (np.arange(len(state.time)) % 400 == 0)

    assert seen(on_joint(spikes)) is None


@pytest.mark.parametrize("weights", [WHITE, SLOW, WAVY, (0.98,)])
def test_noise_has_no_bursts_whatever_it_remembers(weights):
    dataset = measured_arm().dataset
    for seed in range(20):
        rng = np.random.default_rng(seed)
        assert burst(dataset, drawn(weights, rng, len(dataset.time), dataset.joints)) is None


def test_heavy_tails_have_no_bursts():
    dataset = measured_arm().dataset
    for seed in range(20):
        assert (
            burst(dataset, np.random.default_rng(seed).standard_t(3, (len(dataset.time), dataset.joints)))
            is None
        )


def test_what_is_larger_in_half_of_the_log_is_no_burst():
    dataset = measured_arm().dataset
    noise = np.random.default_rng(0).normal(size=(len(dataset.time), dataset.joints))
    noise[dataset.time > 10.0] *= 30.0
    assert burst(dataset, noise) is None


def test_a_joint_that_moves_once_has_no_burst_while_it_does():
    dataset = measured_arm().dataset
    noise = np.random.default_rng(0).normal(size=(len(dataset.time), dataset.joints))
    rests = (dataset.time < BEGIN) | (dataset.time > BEGIN + 2.0)
    noise[rests] *= 1e-3
    assert burst(dataset, noise) is not None
    assert burst(replace(dataset, clear=dataset.clear & ~rests[:, None]), noise) is None


def test_a_channel_that_is_dead_has_no_bursts():
    dataset = measured_arm().dataset
    assert burst(dataset, np.zeros((len(dataset.time), dataset.joints))) is None
