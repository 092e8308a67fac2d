"""Positions that were low-passed are named as such, and no spring is named for what the filter took."""

import pytest

from tests.plant.again import arm_of, logged
from tests.plant.effects.timing import PositionFilter
from veritorque.core.diagnosis.result import Finding
from veritorque.core.log.model import JointLog
from veritorque.core.robot.model import RobotModel
from veritorque.core.study import IdentifyRequest, diagnose_in_full

CUTOFF = 10.0


def findings(robot: RobotModel, log: JointLog) -> tuple[Finding, ...]:
    return diagnose_in_full(IdentifyRequest(robot, (log,), {"bootstrap": {"draws": 0}})).diagnosis.findings


@pytest.mark.slow
def test_a_filter_of_the_positions_is_named_at_its_cutoff_and_no_spring():
    arm = arm_of("planar-3", 1)
    log = logged(arm, 1, PositionFilter((1, 2, 3), CUTOFF, 1))
    found = findings(arm.robot, log)
    assert [one.cause for one in found] == ["position_filter"]
    (size,) = found[0].quantities
    assert abs(size.value - CUTOFF) < 3.0 * size.standard_deviation < 0.5 * CUTOFF
