"""Rows beside reversals: an arm that sticks, weights that tell noise from none, and their lagged products."""

import numpy as np
import pytest

from tests.plant.cases import draw_world
from tests.plant.sensors import record
from veritorque.core.estimate.reversals import reversal_weights
from veritorque.core.regressor.factor import Factor
from veritorque.core.regressor.memory import LaggedProducts, TurningProducts
from veritorque.core.study import IdentifyRequest, identify

QUIET = 0.02
"""Share of the plant's usual sensor noise, so that sticking is the largest error."""


@pytest.mark.parametrize(("robot", "seed"), [("planar-2", 704), ("ur10e", 708)])
def test_an_arm_that_sticks_at_its_reversals_is_predicted_within_a_thousandth_of_its_torque(robot, seed):
    world = draw_world(np.random.default_rng([seed, 0]), seed, robot=robot, noise="white", duration=20.0)
    rng = np.random.default_rng(seed)
    log = record(world.signals(()), QUIET * world.noise_rms, "white", rng)

    def error(*, weighed: bool) -> float:
        options = {"bootstrap": {"draws": 0}, "weigh_reversals": weighed}
        found = identify(IdentifyRequest(world.arm.robot, (log,), options))
        assert found["validation_reversals_percent"] > 5.0 * found["validation_total_percent"]
        return float(found["validation_total_percent"])

    assert error(weighed=True) < min(0.1, 0.7 * error(weighed=False))


def _factors(noise: float, rows: int, rng: np.random.Generator) -> tuple[Factor, ...]:
    columns = rng.normal(size=(rows, 3))
    torque = columns @ np.array([1.0, -2.0, 0.5]) + noise * rng.normal(size=rows)
    return (Factor.of(np.column_stack([columns, torque])),)


@pytest.mark.parametrize(
    ("noise", "rows", "weight"), [(1.0, 300, 1.0), (10.0, 300, 0.1), (0.2, 300, 1.0), (10.0, 5000, 1.0)]
)
def test_the_weight_is_the_ratio_of_the_noises_and_one_where_the_moving_rows_do_not_tell(noise, rows, weight):
    rng = np.random.default_rng(2)
    moving, turning = _factors(1.0, 1000, rng), _factors(noise, rows, rng)
    found = reversal_weights(moving, turning, (np.arange(3),), 3)
    assert found[0] == pytest.approx(weight, rel=0.1)


def test_discounted_products_are_those_of_rows_that_were_weighted_before():
    rng = np.random.default_rng(3)
    rows, turning = rng.normal(size=(90, 4)), rng.random(90) < 0.3
    whole, part = LaggedProducts.empty(4).extended(rows, 0, 90), TurningProducts.empty(4)
    part = part.extended(rows[:40], turning[:40], 0)
    part = part.extended(rows[20:], turning[20:], 20)
    weighted = np.where(turning[:, None], 0.3, 1.0) * rows
    direct = LaggedProducts.empty(4).extended(weighted, 0, 90)
    found, expected = (
        both + np.swapaxes(both, 1, 2) for both in (part.discounted(whole, 0.3).products, direct.products)
    )
    np.testing.assert_allclose(found, expected, atol=1e-12)
