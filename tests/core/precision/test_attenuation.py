"""The predicted attenuation of inertias is what least squares shows, and it is a doubt where it is large."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.estimate.sticking_arm import QUIET, Scene, scene
from veritorque.core.identification.doubts import doubts
from veritorque.core.identification.result import Identification
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.precision.attenuation import attenuation
from veritorque.core.regressor.column_noise import acceleration_columns
from veritorque.core.study import IdentifyRequest, identify_in_full

WIDE = {"filter": {"cutoff_hz": 40.0}}


def fitted(own: Scene, log: object, **options: object) -> Identification:
    asked = {"estimator": "wls", "bootstrap": {"draws": 0}, **options}
    return identify_in_full(IdentifyRequest(own.world.arm.robot, (log,), asked))


def missed_percent(own: Scene, found: Identification, base: np.ndarray) -> np.ndarray:
    """Give what an estimate misses of every joint's true inertia."""
    plan = found.observation.plan
    columns = acceleration_columns(plan, found.observation.positions)
    return np.array(
        [
            100.0 * (1.0 - (inertia @ base[place]) / (inertia @ own.true[place]))
            for joint, (rows, place) in enumerate(zip(plan.rows_of, plan.columns_of, strict=True))
            for inertia in [columns[joint, rows].mean(axis=1)]
        ]
    )


@pytest.mark.parametrize(
    ("robot", "encoder_deg", "options", "rtol"),
    [("planar-2", 0.1, {}, 0.2), ("planar-2", 1e-2, WIDE, 0.1), ("ur10e", 0.1, {}, 0.5)],
)
def test_it_predicts_what_least_squares_misses(robot, encoder_deg, options, rtol):
    own = scene(robot)
    found = [fitted(own, own.log(encoder_deg, QUIET, seed), **options) for seed in range(3)]
    real = missed_percent(own, found[0], np.mean([one.estimate.base for one in found], axis=0))
    predicted = 100.0 * np.mean([one.attenuation.missed for one in found], axis=0)
    largest = np.argmax(real)
    assert real[largest] > 1.0
    np.testing.assert_allclose(predicted[largest], real[largest], rtol=rtol)
    np.testing.assert_allclose(found[0].attenuation.noise, np.deg2rad(encoder_deg), rtol=0.05)


@pytest.fixture(scope="module")
def noisy() -> Identification:
    own = scene("planar-2")
    return fitted(own, own.log(1e-2, QUIET, 0), **WIDE)


def test_it_is_a_doubt_of_least_squares_only_where_it_is_large(noisy):
    own = scene("planar-2")
    assert [doubt for doubt in doubts(noisy) if "too noisy for a band of 40 Hz" in doubt]
    quiet = fitted(own, own.log(1e-2, QUIET, 0))
    assert not [doubt for doubt in doubts(quiet) if "too noisy" in doubt]
    assert not [doubt for doubt in doubts(replace(noisy, estimator="iv")) if "too noisy" in doubt]


def test_it_does_not_depend_on_the_unit_of_torque(noisy):
    own = scene("planar-2")
    rows = whole_rows(own.log(1e-2, QUIET, 0))
    scaled = fitted(own, log_from_arrays("scaled", rows.time, rows.position, 10.0 * rows.torque), **WIDE)
    np.testing.assert_allclose(scaled.attenuation.missed, noisy.attenuation.missed, rtol=1e-6)


def test_it_grows_with_the_square_of_the_noise(noisy):
    seen = noisy.observation
    blocks = seen.parts(noisy.held_out)[0]
    recipe = noisy.motions[0].recipe
    quieter = replace(noisy.motions[0], recipe=replace(recipe, position_noise=0.1 * recipe.position_noise))
    less, more = (
        attenuation(seen, blocks, (motion,), noisy.estimate.base).missed
        for motion in (quieter, noisy.motions[0])
    )
    np.testing.assert_allclose(100.0 * less, more, rtol=1e-9)
