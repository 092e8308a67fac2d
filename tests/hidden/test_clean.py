"""A clean log of the second world, on which a spring was named once."""

import numpy as np
import pytest

from tests.hidden.plan import answered
from tests.plant.cases import Case
from tests.plant.second import draw_second


@pytest.mark.slow
def test_an_encoder_s_error_that_goes_round_the_loop_is_no_spring():
    """Without the test in the motion's own band, a spring is named on this log."""
    robot, log = draw_second(710, "smooth", "white")
    found = answered(Case(robot, log, (), "white", np.zeros(2), "second", 710))
    assert found["verdict"] == "nothing_found"
