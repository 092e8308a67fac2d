"""Effects have the units of the joint that they act on."""

import numpy as np
import pytest

from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.dynamics.terms.friction_stribeck import Stribeck
from veritorque.core.dynamics.terms.joint_elasticity import Elasticity
from veritorque.core.dynamics.terms.spring_compensator import Spring
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import RobotModel

ROW = {"alpha": 0.0, "d": 0.1, "r": 0.0, "theta_offset": 0.0}


@pytest.fixture(scope="module")
def robot() -> RobotModel:
    """Give one joint that turns and one that slides."""
    joints = [{"type": "revolute", **ROW}, {"type": "prismatic", **ROW}]
    return robot_from_description({"name": "two", "joints": joints})


def test_standard_parameters_of_a_slide_are_those_of_a_force_and_a_way(robot):
    units = {one.name: one.unit for one in standard_model(robot).parameters}
    assert [units[f"{name}1"] for name in ("FV", "FC", "OFF", "IA")] == ["N m s/rad", "N m", "N m", "kg m2"]
    assert [units[f"{name}2"] for name in ("FV", "FC", "OFF", "IA")] == ["N s/m", "N", "N", "kg"]


@pytest.mark.parametrize("joint", [1, 2])
def test_further_effects_follow_their_joint(robot, joint):
    described = Prediction(standard_model(robot, ("rigid_body",)), np.zeros(20))
    terms = (Spring(joint), Stribeck(joint, 0.1), Elasticity(joint, described, 10.0, 20.0, 0.1))
    units = [term.parameters(robot)[0].unit for term in terms]
    assert units == [["N m/rad", "N m", "rad/(N m)"], ["N/m", "N", "m/N"]][joint - 1]
