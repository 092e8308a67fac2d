"""Logs of the second world with one textbook effect each, beside which something else was named."""

import numpy as np
import pytest

from tests.hidden.plan import answered
from tests.plant.cases import Case
from tests.plant.second import draw_changed
from tests.plant.sensors import NOISES


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "motion", "cause"),
    [(4017, "smooth", "torque_dead_zone"), (2022, "smooth", "friction_load_dependent")],
)
def test_nothing_is_named_for_sure_beside_the_effect(seed, motion, cause):
    """A dead zone made the other joint's torque seem too large; drag in the load made friction one-sided."""
    noise = NOISES[seed % len(NOISES)]
    robot, log, changes = draw_changed(seed, motion, noise)
    assert [one.cause for one in changes] == [cause]
    found = answered(Case(robot, log, (), noise, np.zeros(2), "second", seed))
    assert [one["cause"] for one in found["findings"] if one["confidence"] > 0.5] == [cause]
