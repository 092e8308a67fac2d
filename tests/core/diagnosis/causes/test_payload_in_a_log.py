"""A body that one of several logs has is named with its mass; a gain error of that log is not called one."""

import pytest

from tests.plant.again import arm_of, logged
from tests.plant.effects.surroundings import PayloadChange
from tests.plant.robots import Arm
from veritorque.core.log.model import JointLog, whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.study import IdentifyRequest, diagnose

PLAIN = {"bootstrap": {"draws": 0}}
ARM = arm_of("planar-2", 2)
MASS, CENTRE = 1.0, (0.2, 0.02, 0.01)


@pytest.fixture(scope="module")
def empty() -> JointLog:
    return logged(ARM, 102, duration=20.0)


def payloads(*logs: JointLog, arm: Arm = ARM) -> list[dict[str, object]]:
    document = diagnose(IdentifyRequest(arm.robot, logs, PLAIN))
    return [found for found in document["diagnosis"]["findings"] if found["cause"] == "payload_change"]


@pytest.mark.parametrize("first", [False, True], ids=["in the second log", "in the first log"])
def test_a_body_in_one_of_two_logs_is_named_with_mass_and_centre(empty, first):
    loaded = logged(ARM, 202, PayloadChange((2,), MASS, *CENTRE, -1.0), duration=20.0)
    (found,) = payloads(*((loaded, empty) if first else (empty, loaded)))
    numbers = {one["name"]: one["value"] for one in found["parameters"]}
    assert found["confidence"] > 0.9
    assert numbers["mass"] == pytest.approx(-MASS if first else MASS, rel=0.05)
    assert numbers["com_x"] == pytest.approx(CENTRE[0], abs=0.01)
    assert numbers["log"] == 2
    assert "in log 2" in found["statement"]


def test_torques_that_are_all_larger_in_one_log_are_no_body_for_sure():
    arm = arm_of("ur10e", 3)
    sound, rows = logged(arm, 103), whole_rows(logged(arm, 203))
    louder = log_from_arrays("louder", rows.time, rows.position, 1.05 * rows.torque)
    assert all(found["confidence"] <= 0.5 for found in payloads(sound, louder, arm=arm))


def test_two_sound_logs_have_no_body(empty):
    assert payloads(empty, logged(ARM, 202, duration=20.0)) == []
