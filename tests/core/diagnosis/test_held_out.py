"""Rows that are held out do not act: whatever stands in them, fits and scans come out the same."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.diagnosis.scenes import Scene, eventful_scene, fitter_of, measured_arm
from veritorque.core.diagnosis.causes.protocol import Cause, Setting
from veritorque.core.diagnosis.causes.registry import CAUSES
from veritorque.core.diagnosis.regression.gls import Fit


def with_garbage(scene: Scene) -> Scene:
    """Put torque that no arm needs into the rows that are held out."""
    dataset = scene.dataset
    garbage = 100.0 * np.random.default_rng(0).normal(size=dataset.torque.shape) * dataset.held_out[:, None]
    return replace(scene, dataset=replace(dataset, torque=dataset.torque + garbage))


def fitted(scene: Scene) -> Fit:
    return fitter_of(scene, ()).fit(()).fit


def test_some_rows_are_held_out():
    assert 0.1 < measured_arm().dataset.held_out.mean() < 0.3


def test_a_fit_does_not_see_what_is_held_out():
    scene = measured_arm()
    np.testing.assert_array_equal(fitted(with_garbage(scene)).values, fitted(scene).values)


@pytest.mark.parametrize("cause", CAUSES, ids=lambda one: one.id)
def test_a_cause_settles_where_to_look_without_what_is_held_out(cause: Cause):
    """Neither its grid nor the columns built on it may depend on rows that are to judge it."""
    clean, spoilt = eventful_scene(), with_garbage(eventful_scene())
    for site in cause.sites(clean.dataset):
        grid = cause.grid(Setting(clean.dataset, clean.operating_point, site))
        assert cause.grid(Setting(spoilt.dataset, spoilt.operating_point, site)) == grid
        terms = [
            cause.term(Setting(one.dataset, one.operating_point, site, grid[0])) for one in (clean, spoilt)
        ]
        before, after = clean.dataset.columns(terms)
        for joint, column in before.items():
            np.testing.assert_array_equal(after[joint], column)
