"""Springs of joints, found in the logs of arms that another engine simulates, or refused."""

from collections.abc import Mapping, Sequence
from functools import cache

import numpy as np
import pytest

from tests.core.estimate.flexible_arm import ONE, THREE, FlexibleArm, Recorded, recorded
from veritorque.core.errors import ExcitationError, OptionError
from veritorque.core.identification.options import parse_options
from veritorque.core.identification.result import Identification
from veritorque.core.study import IdentifyRequest, identify_in_full

FOUND = 0.01
"""Largest relative error of a stiffness, and of a rotor's inertia: what the estimator promises."""
MODE = 12.0


@cache
def record(arm: FlexibleArm, highest_hz: float) -> Recorded:
    return recorded(arm, highest_hz, 8.0)


def identified(
    arm: FlexibleArm, joints: Sequence[int], highest_hz: float = 1.5 * MODE, **options: object
) -> Identification:
    asked: Mapping[str, object] = {
        "estimator": "didim",
        "flexible_joints": list(joints),
        "bootstrap": {"draws": 0},
        **options,
    }
    return identify_in_full(IdentifyRequest(arm.robot, (record(arm, highest_hz).log(1),), asked))


def values(found: Identification, name: str) -> np.ndarray:
    return np.array(
        [part.value for joint in found.flexible_joints for part in joint.quantities if part.name == name]
    )


def test_three_springs_at_once_are_found_within_one_percent_and_told_apart_from_rotors() -> None:
    arm = THREE.with_mode(MODE)
    found = identified(arm, (1, 2, 3))
    assert values(found, "stiffness") == pytest.approx(arm.stiffness, rel=FOUND)
    assert values(found, "motor_inertia") == pytest.approx(arm.rotors, rel=FOUND)
    assert values(found, "damping") == pytest.approx(arm.damping, rel=0.05)  # it shows at the mode alone
    assert found.feasible
    assert found.convergence.converged


def test_a_rigid_joint_between_flexible_ones_stays_rigid() -> None:
    arm = THREE.with_mode(MODE, np.inf, MODE)
    found = identified(arm, (1, 3))
    assert [joint.joint for joint in found.flexible_joints] == [1, 3]
    assert values(found, "stiffness") == pytest.approx(arm.stiffness[[0, 2]], rel=FOUND)


def test_the_frequencies_of_one_joint_follow_from_its_inertias_and_spring() -> None:
    arm = ONE.with_mode(MODE)
    found = identified(arm, (1,))
    stiffness, motor, link, low, high = (
        values(found, name)[0]
        for name in ("stiffness", "motor_inertia", "link_inertia", "antiresonance", "natural")
    )
    assert 2.0 * np.pi * low == pytest.approx(np.sqrt(stiffness / link))
    assert 2.0 * np.pi * high == pytest.approx(np.sqrt(stiffness / link + stiffness / motor))
    assert link == pytest.approx(ONE.masses[0] * (0.25**2 + 0.02**2) + ONE.inertias[0][2], rel=FOUND)


@pytest.mark.parametrize("band", [{}, {"filter": {"cutoff_hz": 40.0}}])
def test_a_rigid_arm_that_is_called_flexible_is_given_no_stiffness(band: Mapping[str, object]) -> None:
    with pytest.raises(ExcitationError, match="do not show that joint 1 is flexible") as refused:
        identified(ONE.with_mode(np.inf), (1,), 30.0, **band)
    assert "joint_1" in refused.value.evidence


def test_a_spring_is_refused_whose_mode_carries_hardly_any_torque() -> None:
    with pytest.raises(ExcitationError, match="of its RMS around the mode, less than 5 %"):
        identified(ONE.with_mode(100.0), (1,), 18.0)


def test_joints_that_cannot_be_flexible_are_refused_with_a_remedy() -> None:
    arm = ONE.with_mode(MODE)
    with pytest.raises(OptionError, match="joint 2 cannot be flexible: the robot has no such joint"):
        identified(arm, (2,))
    with pytest.raises(OptionError, match="no inertia of its rotor"):
        identified(arm, (1,), terms=["rigid_body", "viscous"])


@pytest.mark.parametrize(
    "options",
    [
        {"flexible_joints": [1]},
        {"flexible_joints": [1], "estimator": "clie"},
        {"flexible_joints": [1], "estimator": "didim", "simulation": {"from": "controller"}},
        {"flexible_joints": [2, 1], "estimator": "didim"},
        {"flexible_joints": [0], "estimator": "didim"},
    ],
)
def test_flexible_joints_are_asked_of_didim_by_replay_in_rising_order(options: Mapping[str, object]) -> None:
    with pytest.raises(OptionError) as refused:
        parse_options(options)
    assert refused.value.evidence["pointer"] == "/options/flexible_joints"
