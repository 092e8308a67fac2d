"""Log joints that keep their speed: what the torque tells is identified, what tells too little is refused."""

import numpy as np
import pytest

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import ExcitationError
from veritorque.core.log.model import JointLog, whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.report.page.page import compose_page
from veritorque.core.robot.description import robot_from_description
from veritorque.core.signals.state import MotionState
from veritorque.core.study import IdentifyRequest, diagnose, identify

MODEL = standard_model(planar_robot())
SPEED = 0.1
"""Of a joint that keeps its speed, rad/s."""


def log_with_constant(joints: list[int], speed: float = SPEED) -> JointLog:
    """Log a planar arm some of whose joints (from 0) keep their speed."""
    moving = swing(len(MODEL.robot.joints), seed=1)
    time = np.arange(len(moving.position)) / 100.0
    position, velocity, acceleration = (
        one.copy() for one in (moving.position, moving.velocity, moving.acceleration)
    )
    position[:, joints] = speed * (time - 5.0)[:, None]
    velocity[:, joints], acceleration[:, joints] = speed, 0.0
    state = MotionState(position, velocity, acceleration)
    noise = 0.02 * np.random.default_rng(1).normal(size=position.shape)
    return log_of(MODEL, true_parameters(MODEL), state, noise)


@pytest.mark.parametrize("study", [identify, diagnose])
@pytest.mark.parametrize("estimator", ["sdp", "ols"])
def test_a_motion_in_which_no_joint_changes_its_speed_is_refused_for_want_of_excitation(study, estimator):
    log = log_with_constant([0, 1])
    with pytest.raises(ExcitationError, match="no joint changes its speed") as refusal:
        study(IdentifyRequest(MODEL.robot, (log,), {"estimator": estimator}))
    assert {"ZZ1", "ZZ2"} <= set(refusal.value.evidence["parameters_not_excited"])
    assert "speeds up" in refusal.value.remedy


def test_beside_a_joint_that_keeps_its_speed_the_others_inertia_is_identified():
    document = identify(IdentifyRequest(MODEL.robot, (log_with_constant([0]),)))
    (found,) = [
        one for one in document["base_parameters"] if one["name"].startswith("ZZ") and one["joint"] == 2
    ]
    truth = dict(zip((one.name for one in MODEL.parameters), true_parameters(MODEL), strict=True))
    expected = sum(weight * truth[name] for name, weight in found["relation"].items())
    assert abs(found["value"] - expected) < 4.0 * found["standard_deviation"] < 0.4 * expected
    assert min(document["feasibility"]["pseudo_inertia_min_eigenvalue"]) > 0.0


def test_the_error_of_a_joint_that_stands_is_not_known_and_not_zero():
    document = diagnose(IdentifyRequest(MODEL.robot, (log_with_constant([0], speed=0.0),)))
    for side in (document, document["diagnosis"]["before"], document["diagnosis"]["after"]):
        for row in [*(side.get("fit") or []), *(side.get("validation") or [])]:
            known = {name for name, value in row.items() if value is not None}
            assert ("rms_residual" in known) == (row["joint"] == 2)
            assert known >= {"joint", "samples"}


def test_a_joint_that_stands_gains_nothing_that_is_known_and_has_no_bar_in_the_report():
    log = log_with_constant([0], speed=0.0)
    rows = whole_rows(log)
    spring = rows.torque + 8.0 * rows.position * [0.0, 1.0]
    sprung = log_from_arrays("sprung", rows.time, rows.position, spring)
    document = diagnose(IdentifyRequest(MODEL.robot, (sprung,)))
    still, moving = document["diagnosis"]["gain"]
    assert still == {"joint": 1, "held_out": True} | dict.fromkeys(still.keys() - {"joint", "held_out"})
    assert moving["improvement_percent"] > 0.0
    (finding,) = document["diagnosis"]["findings"]
    assert [value is None for value in finding["gain"]["improvement_percent"]] == [True, False]
    page = compose_page(document)
    assert "joint 2:" in page
    assert "joint 1:" not in page
    page = compose_page(identify(IdentifyRequest(MODEL.robot, (log,))))
    assert "on every joint that moves)" in page


def test_a_body_that_a_slide_takes_up_is_named_though_no_moment_of_inertia_shows():
    slide = {"type": "prismatic", "alpha": 0.0, "d": 0.0, "r": 0.0, "theta_offset": 0.0}
    robot = robot_from_description({"name": "slide", "joints": [slide], "gravity": [0.0, 0.0, 0.0]})
    time = np.arange(6000) / 250.0
    position = 0.1 * np.sin(2.2 * time) + 0.05 * np.sin(5.0 * time + 1.0) + 0.02 * np.sin(12.0 * time + 2.0)
    velocity = np.gradient(position, time)
    torque = (20.0 + 5.0 * (time > 12.0)) * np.gradient(velocity, time)
    torque += 30.0 * velocity + 4.0 * np.sign(velocity)
    torque += 0.3 * np.random.default_rng(1).normal(size=len(time))
    log = log_from_arrays("taken up", time, position[:, None], torque[:, None])
    found = diagnose(IdentifyRequest(robot, (log,)))["diagnosis"]["findings"]
    assert "payload_change" in {finding["cause"] for finding in found}
