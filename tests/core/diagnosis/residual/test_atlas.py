"""Hold the atlas to finding an effect over its own coordinate, and to finding nothing in noise."""

import numpy as np
import pytest
from scipy.stats import binom

from tests.core.diagnosis.residual.worlds import NOISES, on_joint, world
from veritorque.core.diagnosis.residual.atlas import BINS, atlas


def dependence(found, coordinate, joint):
    """Give one dependence of an atlas by coordinate and joint, from 1."""
    return next(own for own in found.dependences if (own.coordinate, own.joint) == (coordinate, joint))


@pytest.mark.parametrize("kind", NOISES)
def test_noise_depends_on_no_coordinate_whatever_its_colour(kind):
    here = world()
    residual, noise = here.left(here.noise(kind, seed=21))
    found = atlas(here.dataset, residual, here.operating_point, noise).dependences
    p_values = np.array([one.p_value for one in found])
    assert p_values.min() > 1e-3 / len(found)
    # Dependences share rows: a tenth below 0.1 is allowed the scatter of a fifth of their number.
    allowed = 5 * binom.ppf(0.999, len(found) // 5, 0.1)  # 30 of 98
    assert np.sum(p_values < 0.1) <= allowed


@pytest.mark.parametrize(
    ("name", "effect"),
    [
        ("position", lambda state, joint: np.cos(17.0 * state.position[:, joint])),
        ("velocity", lambda state, joint: np.cos(5.0 * state.velocity[:, joint])),
        ("acceleration", lambda state, joint: np.cos(2.0 * state.acceleration[:, joint])),
        ("velocity_of_joint_6", lambda state, joint: np.cos(2.0 * state.velocity[:, 5]) + 0.0 * joint),
    ],
)
def test_a_function_of_a_coordinate_is_found_over_that_coordinate_first(name, effect):
    here = world()
    disturbance = on_joint(here, 2, effect(here.dataset.state, 1)) + here.noise("white", seed=22)
    residual, noise = here.left(disturbance)
    found = atlas(here.dataset, residual, here.operating_point, noise)
    first = min((one for one in found.dependences if one.joint == 2), key=lambda one: one.p_value)
    assert first.coordinate == name
    assert first.p_value < 1e-9
    assert min(one.p_value for one in found.dependences if one.joint == 5) > 1e-6


def test_the_bins_show_the_function_that_was_put_in():
    here = world()
    position = here.dataset.state.position[:, 1]
    disturbance = on_joint(here, 2, np.cos(17.0 * position))
    residual, noise = here.left(disturbance + 0.2 * here.noise("white", seed=23))
    found = atlas(here.dataset, residual, here.operating_point, noise)
    shown = dependence(found, "position", 2)
    assert np.corrcoef(shown.mean, np.cos(17.0 * shown.centre))[0, 1] > 0.9
    assert shown.count.sum() == here.dataset.clear[:, 1].sum()
    assert len(shown.mean) == BINS == shown.degrees_of_freedom + 1
    assert (np.diff(shown.centre) > 0.0).all()


@pytest.mark.parametrize("kind", ["white", "ar_0.98"])
def test_the_standard_errors_are_the_scatter_of_the_bins(kind):
    here = world()
    scatter, told = [], []
    for seed in range(30, 38):
        drawn = here.noise(kind, seed)
        _, noise = here.left(drawn)
        shown = atlas(here.dataset, drawn, here.operating_point, noise[:1] * 7)
        scatter.append([one.mean for one in shown.dependences if one.coordinate == "position"])
        told.append([one.standard_error for one in shown.dependences if one.coordinate == "position"])
    ratio = np.sqrt(np.mean(np.square(told)) / np.mean(np.square(scatter)))
    # A fit to the noise takes part of its slow swing, so errors learned after it are a little small.
    assert 0.75 < ratio < 1.25


def test_rows_near_reversals_do_not_count():
    here = world()
    residual, noise = here.left(here.noise("white", seed=24))
    found = atlas(here.dataset, residual, here.operating_point, noise)
    away = dependence(found, "travel", 1)
    assert away.count.sum() == here.dataset.clear[:, 0].sum() < here.dataset.usable[:, 0].sum()


def test_a_spectrum_holds_the_residuals_power_and_white_noise_lies_on_its_floor():
    here = world()
    drawn = here.noise("white", seed=25)
    _, noise = here.left(drawn)
    found = atlas(here.dataset, drawn, here.operating_point, noise)
    for one in found.spectra:
        usable = here.dataset.usable[:, one.joint - 1]
        power = np.trapezoid(one.density, one.frequency_hz)
        assert power == pytest.approx(np.mean(drawn[usable, one.joint - 1] ** 2), rel=0.15)
        below = (one.frequency_hz > 1.0) & (one.frequency_hz < 0.7 * here.dataset.band_hz)
        # a dozen windows: the mean over the band scatters by a few per cent
        assert np.mean(one.density[below] / one.floor[below]) == pytest.approx(1.0, abs=0.25)
