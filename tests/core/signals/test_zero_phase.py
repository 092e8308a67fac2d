"""The low-pass kernel against scipy's forward-backward filter, and against its own promise.

Tolerance 1e-10 of the signal's size: the kernel is cut at 1e-14 of its peak and scipy's recursion rounds to
about 1e-13; a wrong pole or a shift of one sample shows in the first digits.
"""

import numpy as np
import pytest
from scipy import signal

from veritorque.core.errors import OptionError
from veritorque.core.signals.parallel import ParallelFilter
from veritorque.core.signals.zero_phase import gain, kernel, modes, reach_of

CASES = [
    (10.0, 250.0, 5),
    (3.0, 95.0, 5),
    (100.0, 5000.0, 4),
    (0.5, 100.0, 2),
    (40.0, 100.0, 5),
    (30.0, 1000.0, 8),
]


@pytest.mark.parametrize(("cutoff_hz", "rate_hz", "order"), CASES)
def test_the_kernel_filters_like_scipy_away_from_the_ends(cutoff_hz, rate_hz, order):
    response = kernel(cutoff_hz, rate_hz, order)
    samples = 3 * len(response)
    noise = np.random.default_rng(1).normal(size=samples)
    expected = signal.sosfiltfilt(signal.butter(order, cutoff_hz, fs=rate_hz, output="sos"), noise)
    inside = slice(len(response), -len(response))
    assert np.max(np.abs(np.convolve(noise, response, mode="same") - expected)[inside]) < 1e-10


@pytest.mark.parametrize(("cutoff_hz", "rate_hz", "order"), CASES)
def test_a_sine_at_the_cut_off_comes_out_at_half_its_size_without_delay(cutoff_hz, rate_hz, order):
    response = kernel(cutoff_hz, rate_hz, order)
    sine = np.sin(2.0 * np.pi * cutoff_hz * np.arange(3 * len(response)) / rate_hz + 0.3)
    filtered = np.convolve(sine, response, mode="valid")
    reach = len(response) // 2
    assert np.max(np.abs(filtered - 0.5 * sine[reach:-reach])) < 1e-10


@pytest.mark.parametrize(("cutoff_hz", "rate_hz", "order"), CASES)
def test_the_gain_is_that_of_two_passes_of_scipys_filter(cutoff_hz, rate_hz, order):
    frequency = np.linspace(0.0, 0.49 * rate_hz, 50)
    _, once = signal.sosfreqz(
        signal.butter(order, cutoff_hz, fs=rate_hz, output="sos"), frequency, fs=rate_hz
    )
    promised = gain(frequency, cutoff_hz=cutoff_hz, rate_hz=rate_hz, order=order)
    assert np.max(np.abs(promised - np.abs(once) ** 2)) < 1e-10


def test_a_constant_passes_unchanged():
    for cutoff_hz, rate_hz, order in CASES:
        assert abs(kernel(cutoff_hz, rate_hz, order).sum() - 1.0) < 1e-12


def test_a_straight_line_passes_unchanged():
    response = kernel(10.0, 250.0, 5)
    line = np.linspace(-3.0, 8.0, 4 * len(response))
    reach = len(response) // 2
    assert np.max(np.abs(np.convolve(line, response, mode="valid") - line[reach:-reach])) < 1e-11


def test_beyond_its_reach_a_kernel_holds_no_more_than_the_share():
    response = kernel(10.0, 250.0, 5)
    reach, middle = reach_of(response, 1e-3), len(response) // 2
    mass = np.abs(response) / np.abs(response).sum()
    assert mass[middle + reach + 1 :].sum() <= 1e-3 < mass[middle + reach :].sum()


@pytest.mark.parametrize(
    ("cutoff_hz", "order"), [(0.0, 5), (-1.0, 5), (50.0, 5), (80.0, 5), (10.0, 0), (10.0, 13), (np.nan, 5)]
)
def test_a_filter_that_cannot_be_built_is_refused_with_its_limits(cutoff_hz, order):
    with pytest.raises(OptionError) as refusal:
        kernel(cutoff_hz, 100.0, order)
    assert refusal.value.evidence["nyquist_hz"] == 50.0
    assert refusal.value.remedy


@pytest.mark.parametrize("decimation", [1, 3, 40])
@pytest.mark.parametrize("order", [1, 4, 5, 12])
@pytest.mark.parametrize("whole", [True, False])
@pytest.mark.parametrize(("first", "kept"), [(0, 5), (300, 64), (7, 65), (900, 200)])
def test_the_parallel_filter_equals_filtering_first_and_thinning_after(decimation, order, whole, first, kept):
    response = kernel(10.0, 250.0, order)
    parallel = ParallelFilter(response, modes(10.0, 250.0, order), decimation)
    samples = first + decimation * kept + 20
    series, zeros = np.random.default_rng(2).normal(size=(3, samples)), len(response)
    whole_series = np.array(
        [np.convolve(row, response, mode="same") for row in np.pad(series, ((0, 0), (zeros, zeros)))]
    )
    expected = whole_series[:, zeros:-zeros][:, first::decimation][:, :kept]
    found = parallel.apply_in_parts(lambda part: series[:, part], samples, first, kept, whole=whole)
    assert np.max(np.abs(found - expected)) < 1e-12


@pytest.mark.parametrize(("first", "kept"), [(-700, 90), (-3, 10), (500, 8), (2_000, 5), (40, 0)])
def test_instants_before_and_behind_the_series_see_what_the_kernel_reaches(first, kept):
    response = kernel(10.0, 250.0, 5)
    series, beyond = np.random.default_rng(4).normal(size=(2, 480)), 3_000
    padded = np.pad(series, ((0, 0), (beyond, beyond)))
    filtered = np.array([np.convolve(row, response, mode="same") for row in padded])
    expected = filtered[:, beyond + first :: 10][:, :kept]
    found = ParallelFilter(response, modes(10.0, 250.0, 5), 10).apply(series, first, kept)
    assert found.shape == expected.shape
    assert np.max(np.abs(found - expected), initial=0.0) < 1e-12


@pytest.mark.parametrize("order", range(1, 13))
@pytest.mark.parametrize(("cutoff_hz", "rate_hz"), [(10.0, 250.0), (0.3, 1000.0), (45.0, 100.0)])
def test_a_kernel_is_the_sum_of_its_modes_away_from_its_middle(order, cutoff_hz, rate_hz):
    response, found = kernel(cutoff_hz, rate_hz, order), modes(cutoff_hz, rate_hz, order)
    lags = np.arange(1, len(response) // 2 + 1)
    half = response[len(response) // 2 :]
    decays = np.real(np.sum(found.weights[:, None] * found.poles[:, None] ** lags, axis=0))
    assert np.max(np.abs(decays - half[1:])) < 1e-12 * half[0]


def test_the_influence_of_marks_is_the_share_of_the_kernel_that_sees_them():
    response = kernel(10.0, 250.0, 5)
    size = len(response)
    parallel = ParallelFilter(response, modes(10.0, 250.0, 5), 5)
    assert np.allclose(parallel.influence(np.ones((1, 5 * size)), 2 * size, 8), 1.0, atol=1e-12)
    assert not parallel.influence(np.zeros((1, 5 * size)), 2 * size, 8).any()
    half = np.zeros((1, 5 * size))
    half[0, 2 * size + 1 :] = 1.0
    beyond = np.abs(response[size // 2 + 1 :]).sum() / np.abs(response).sum()
    assert abs(parallel.influence(half, 2 * size, 1)[0, 0] - beyond) < 1e-12
