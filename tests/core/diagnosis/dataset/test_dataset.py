"""Hold the rows of a diagnosis to a torque that the model explains: what they leave of it must be nothing."""

import numpy as np
import pytest

from tests.core.diagnosis.scenes import Scene, fitter_of, look_at_arm, measured_arm
from tests.core.estimate.worlds import planar_robot
from veritorque.core.diagnosis.dataset.dataset import Dataset, build_dataset
from veritorque.core.diagnosis.dataset.refusals import refuse_too_little
from veritorque.core.diagnosis.search.residuals import residual
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import ExcitationError
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.regressor.columns import all_columns
from veritorque.core.signals.recipe import FilterOptions

NEGLIGIBLE = 5e-4
"""RMS of what filters may leave of a torque without noise, N m: a hundredth of the noise of most scenes."""


SPIKES = (4.0, 8.0, 12.0)
"""When each joint's position has a spike, s."""


def is_masked(scene: Scene) -> np.ndarray:
    """Give the RMS per joint of what a plain fit leaves, but for the rows next to the log's ends."""
    fitter = fitter_of(scene, ())
    left, dataset = residual(fitter, fitter.fit(())), scene.dataset
    inner = dataset.usable & ((dataset.time > 0.2) & (dataset.time < dataset.time[-1] - 0.2))[:, None]
    return np.sqrt(np.sum(left**2 * inner, axis=0) / inner.sum(axis=0))


def with_spikes(scene: Scene) -> Scene:
    """Put a spike of half a radian on one sample of every joint's position."""
    rows = whole_rows(scene.dataset.motions[0].log)
    position = rows.position.copy()
    position[np.searchsorted(rows.time, SPIKES), [0, 1, 2]] += 0.5
    return look_at_arm(position, rows.torque)


def median_order(dataset: Dataset) -> int:
    return dataset.motions[0].recipe.median_order


def test_a_torque_that_the_model_explains_leaves_nothing_at_turning_points_neither():
    scene = measured_arm(noise=1e-6)
    assert median_order(scene.dataset) == 1
    assert (is_masked(scene) < NEGLIGIBLE).all()


def test_spikes_of_positions_are_cut_and_the_tips_of_turning_points_with_them_where_there_are_some(
    monkeypatch,
):
    scene = with_spikes(measured_arm(noise=1e-6))
    assert median_order(scene.dataset) == 5
    monkeypatch.setattr(FilterOptions, "median_order", 1)
    assert (is_masked(scene) < 0.5 * is_masked(with_spikes(measured_arm(noise=1e-6)))).all()


def test_a_log_whose_stamps_scatter_is_refused_for_its_stamps_and_not_for_its_motion():
    time, rng = np.arange(0.0, 20.0, 0.004), np.random.default_rng(3)
    angle = np.column_stack([np.sin(1.3 * time), np.sin(2.1 * time)])
    stamps = np.maximum.accumulate(time + rng.exponential(0.004, len(time))) + 1e-6 * np.arange(len(time))
    model = standard_model(planar_robot(), ("rigid_body",))
    log = log_from_arrays("scattered", stamps, angle, -angle)
    dataset = build_dataset(model, (log,), held_out=frozenset(), blocks=5)
    with pytest.raises(ExcitationError, match="stamps scatter"):
        refuse_too_little(dataset, all_columns(model))
