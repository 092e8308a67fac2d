"""Clean logs of the second world: a spring was named once, and load friction where torques are cut off."""

import numpy as np
import pytest

from tests.hidden.plan import answered
from tests.plant.cases import Case
from tests.plant.second import draw_second
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays


@pytest.mark.slow
def test_an_encoder_s_error_that_goes_round_the_loop_is_no_spring():
    """Without the test in the motion's own band, a spring is named on this log."""
    robot, log = draw_second(710, "smooth", "white")
    found = answered(Case(robot, log, (), "white", np.zeros(2), "second", 710))
    assert found["verdict"] == "nothing_found"


@pytest.mark.slow
def test_torques_that_may_be_cut_off_are_no_friction_of_the_load():
    """Where the model cannot tell whether they are, what depends on the torque's sign is doubtful."""
    robot, log = draw_second(901, "rich", "ar1")
    rows = whole_rows(log)
    step = 0.1 * np.abs(rows.torque).max(axis=0)
    cut = log_from_arrays("cut", rows.time, rows.position, step * np.trunc(rows.torque / step))
    found = answered(Case(robot, cut, (), "ar1", np.zeros(2), "second", 901))["findings"]
    zones = {tuple(one["joints"]): one for one in found if one["cause"] == "torque_dead_zone"}
    assert {joint: one["confidence"] for (joint,), one in zones.items()} == pytest.approx({1: 0.5, 2: 0.99})
    for (joint,), one in zones.items():
        assert one["parameters"][0]["value"] == pytest.approx(step[joint - 1])
    assert all(one["confidence"] <= 0.5 for one in found if one["cause"] != "torque_dead_zone")
