"""Logs of the second world with textbook effects, beside which something else was named."""

import numpy as np
import pytest

from tests.hidden.plan import answered
from tests.plant.cases import Case
from tests.plant.second import draw_changed
from tests.plant.sensors import NOISES


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "motion"), [(5002, "rich"), (2022, "smooth")])
def test_nothing_is_named_beside_the_effects(seed, motion):
    """Beside a dead zone load friction and gains were named; drag in the load made friction one-sided."""
    noise = NOISES[seed % len(NOISES)]
    robot, log, changes = draw_changed(seed, motion, noise)
    found = answered(Case(robot, log, (), noise, np.zeros(2), "second", seed))
    assert {one["cause"] for one in found["findings"]} == {one.cause for one in changes}
