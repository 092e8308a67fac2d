"""Clean logs of the second world: a spring was named once, and load friction where torques are cut off."""

import numpy as np
import pytest

from tests.hidden.plan import answered
from tests.plant.cases import Case
from tests.plant.second import draw_second
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays


@pytest.mark.slow
def test_an_encoder_s_error_that_goes_round_the_loop_is_no_spring():
    """Without the test in the motion's own band, a spring is named on this log.

    The quantiser in the loop makes another log of it where a processor rounds otherwise.
    """
    robot, log = draw_second(710, "smooth", "white")
    found = answered(Case(robot, log, (), "white", np.zeros(2), "second", 710))
    assert all(one["cause"] != "joint_elasticity" for one in found["findings"])
    assert all(one["confidence"] <= CONFIDENCE.doubtful for one in found["findings"])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "noise", "share", "confidence"),
    [(901, "ar1", 0.1, 0.99), (921, "ar1", 0.005, 0.5)],
    ids=["by its other channel", "by its zeros alone"],
)
def test_torques_that_are_cut_off_are_no_friction_of_the_load(seed, noise, share, confidence):
    """One recorder writes all channels: the model tells of the second joint that it cuts, or of none."""
    robot, log = draw_second(seed, "rich", noise)
    rows = whole_rows(log)
    step = share * np.abs(rows.torque).max(axis=0)
    cut = log_from_arrays("cut", rows.time, rows.position, step * np.trunc(rows.torque / step))
    found = answered(Case(robot, cut, (), noise, np.zeros(2), "second", seed))["findings"]
    assert {one["cause"] for one in found} == {"torque_dead_zone"}
    assert [one["confidence"] for one in found] == pytest.approx([confidence, confidence])
    for one in found:
        assert one["parameters"][0]["value"] == pytest.approx(step[one["joints"][0] - 1])
