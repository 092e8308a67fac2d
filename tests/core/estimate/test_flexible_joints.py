"""Springs of joints, found in the logs of arms that another engine simulates, or refused."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tests.core.estimate.flexible_arm import ONE, THREE, FlexibleArm, Recorded, recorded
from veritorque.core.document.model.model_file import read_model, write_model
from veritorque.core.document.model.reading import identified_model
from veritorque.core.document.model.reference import reference_from_document
from veritorque.core.errors import ExcitationError, OptionError
from veritorque.core.estimate import flexible_start
from veritorque.core.estimate.flexible_start import FlexibleStart
from veritorque.core.estimate.problem import Problem
from veritorque.core.identification import flexible_band
from veritorque.core.identification.options import parse_options
from veritorque.core.identification.result import Identification
from veritorque.core.identification.spring_evidence import refuse_hidden
from veritorque.core.study import IdentifyRequest, identify, identify_in_full

FOUND = 0.01
"""Largest relative error of a stiffness, and of a rotor's inertia: what the estimator promises."""
MODE = 12.0


@cache
def record(arm: FlexibleArm, highest_hz: float) -> Recorded:
    return recorded(arm, highest_hz, 12.0 if np.isinf(arm.mode_hz[0]) else 6.0)


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


def test_a_rigid_arm_that_is_called_flexible_is_given_no_stiffness() -> None:
    # In this band a light link behind a soft spring fits the log with a deviation of 0.3 %.
    with pytest.raises(ExcitationError, match="explains the torque no better than a rigid one") as refused:
        identified(ONE.with_mode(np.inf), (1,), 30.0, filter={"cutoff_hz": 40.0})
    assert set(refused.value.evidence["joint_1"]) >= {"natural_hz", "stiffness_deviation_percent"}
    assert "joint 1 is flexible: a flexible joint explains" in refused.value.cause


# The start leads to a spring that is seven times too soft; of three joints, to a link without inertia.
@pytest.mark.parametrize(("arm", "mode", "cutoff_hz"), [(ONE, 40.0, 5.0), (THREE, MODE, 5.0)])
def test_a_filter_that_hides_a_spring_is_named_with_the_mode_and_the_cut_off_that_shows_it(
    arm: FlexibleArm, mode: float, cutoff_hz: float
) -> None:
    arm, joints = arm.with_mode(mode), range(1, arm.joints + 1)
    with pytest.raises(ExcitationError, match=rf"filter\.cutoff_hz is {cutoff_hz:g} Hz") as refused:
        identified(arm, joints, 1.5 * mode, filter={"cutoff_hz": cutoff_hz})
    evidence = refused.value.evidence
    assert evidence["pointer"] == "/options/filter/cutoff_hz"
    assert evidence["mode_hz"] == pytest.approx(mode, rel=0.01)
    assert all(np.isfinite(list(own.values())).all() for own in evidence.values() if isinstance(own, dict))
    needed = float(refused.value.remedy.split()[-2])
    if arm.joints == 1:
        found = identified(arm, joints, 1.5 * mode, filter={"cutoff_hz": needed})
        assert values(found, "stiffness") == pytest.approx(arm.stiffness, rel=FOUND)


def test_no_band_is_begun_with_twice_where_no_spring_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    tried: list[float] = []

    def begin(problem: Problem) -> FlexibleStart:
        tried.append(problem.motions[0].recipe.cutoff_hz)
        return flexible_start.begin(problem)

    monkeypatch.setattr(flexible_band, "begin", begin)
    with pytest.raises(ExcitationError, match="joint 1 is flexible"):
        identified(ONE.with_mode(np.inf), (1,), 30.0)
    assert len(tried) > 1
    assert min(np.diff(np.log(np.sort(tried)))) > np.log1p(0.1)


def test_a_joint_that_stands_is_refused_as_flexible_before_anything_is_fitted() -> None:
    moved = record(THREE.with_mode(MODE), 1.5 * MODE)
    still = replace(moved, position=moved.position * [1.0, 1.0, 0.0])
    asked = {"estimator": "didim", "flexible_joints": [1, 2, 3]}
    stages: list[str] = []
    with pytest.raises(ExcitationError, match="joint 3 is flexible: it stands") as refused:
        identify_in_full(
            IdentifyRequest(THREE.robot, (still.log(1),), asked), lambda stage, _: stages.append(stage)
        )
    assert refused.value.evidence["joints"] == [3]
    assert not {"observe", "estimate"} & set(stages)


@pytest.mark.parametrize(
    ("reasons", "said"),
    [
        ({1: [], 2: ["a", "b"]}, "that joint 2 is flexible: a and b"),
        ({1: ["a"], 3: ["b"]}, "that joints 1 and 3 are flexible: joint 1: a; joint 3: b"),
    ],
)
def test_a_refusal_names_each_joint_once_where_there_is_one(
    reasons: Mapping[int, list[str]], said: str
) -> None:
    with pytest.raises(ExcitationError) as refused:
        refuse_hidden({joint: {"natural_hz": 50.0} for joint in reasons}, reasons)
    assert refused.value.cause.endswith(said)


def test_a_spring_is_refused_whose_mode_carries_hardly_any_torque() -> None:
    with pytest.raises(ExcitationError, match="of its RMS around the mode, less than 5 %"):
        identified(ONE.with_mode(100.0), (1,), 18.0, filter={"cutoff_hz": 40.0})


def test_a_result_says_how_well_a_spring_is_known_and_reads_back_with_it() -> None:
    arm = ONE.with_mode(MODE)
    asked = {"estimator": "didim", "flexible_joints": [1], "bootstrap": {"draws": 0}}
    document = identify(IdentifyRequest(arm.robot, (record(arm, 1.5 * MODE).log(1),), asked))
    (joint,) = document["estimation"]["flexible_joints"]
    stiffness = joint["quantities"][0]
    low, high = stiffness["interval_95"]
    assert (stiffness["name"], stiffness["unit"]) == ("stiffness", "N m/rad")
    assert low < stiffness["value"] < high
    assert any("Joint 1 is flexible" in sentence for sentence in document["estimation"]["statements"])
    again = read_model(write_model(identified_model(document)))
    assert again.values["KS1"] == pytest.approx(stiffness["value"])
    with pytest.raises(OptionError, match="flexible joints, with which no later log is compared"):
        reference_from_document(document, arm.robot, "earlier")


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
        {"flexible_joints": [1.5], "estimator": "didim"},
    ],
)
def test_flexible_joints_are_asked_of_didim_by_replay_in_rising_order(options: Mapping[str, object]) -> None:
    with pytest.raises(OptionError) as refused:
        parse_options(options)
    assert refused.value.evidence["pointer"] == "/options/flexible_joints"
