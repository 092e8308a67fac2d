"""Distinguish robots by what determines their torque, and by nothing else."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.diagnosis.scenes import bodies_of_skew_arm, skew_arm
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.differences import differences
from veritorque.core.robot.model import Coupling, Limits
from veritorque.core.robot.writing import to_description

ARM = skew_arm()


@pytest.mark.parametrize(
    "same",
    [
        ARM,
        replace(ARM, name="another"),
        replace(ARM, prior=bodies_of_skew_arm()),
        replace(ARM, joints=tuple(replace(one, limits=Limits(velocity=1.0)) for one in ARM.joints)),
        robot_from_description(to_description(ARM)),
    ],
    ids=["itself", "its name", "its bodies", "its limits", "written and read"],
)
def test_names_limits_and_bodies_do_not_make_another_robot(same):
    assert differences(ARM, same) == ()


@pytest.mark.parametrize(
    ("other", "word"),
    [
        (replace(ARM, gravity=np.array([0.0, 0.1, -9.81])), "gravity"),
        (replace(ARM, links=(*ARM.links[:2], replace(ARM.links[2], kind="prismatic"))), "link 3"),
        (replace(ARM, joints=(*ARM.joints[:2], replace(ARM.joints[2], rotor_inertia=False))), "joint 3"),
        (replace(ARM, couplings=(Coupling("wrist", 3, (2, 3), (1.0, 1.0)),)), "couplings"),
        (replace(ARM, links=ARM.links[:2], joints=ARM.joints[:2]), "number of joints"),
    ],
    ids=["gravity", "link", "drive", "couplings", "joints"],
)
def test_what_changes_the_torque_makes_another_robot(other, word):
    assert any(word in one for one in differences(ARM, other))
    assert differences(other, ARM)
