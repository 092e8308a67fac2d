"""Hold findings to what they leave: a torque of several joints' angles is no spring of one of them."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from tests.core.diagnosis.scenes import fitter_of, recording, scene_of
from tests.plant import second
from veritorque.core.diagnosis.causes.protocol import Cause
from veritorque.core.diagnosis.causes.spring_compensator import SpringCompensator
from veritorque.core.diagnosis.causes.time_delay import TimeDelay
from veritorque.core.diagnosis.checks.structure_left import (
    StructureLeft,
    StructureTest,
    likeliest_process,
    structure_test,
)
from veritorque.core.diagnosis.search.likelihood_ratio import likelihood_ratio
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE, STRUCTURE_LEFT
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.study import IdentifyRequest, diagnose

JOINT, DELAY_S = 2, 0.01
DRAWS, FUNCTIONS = 3000, 30
SECONDS, STIFFNESS, LENGTH, REACH, FIXED = 25.0, 20.0, 0.2, 0.3, 0.2 + 0.3j
"""A spring of so many N/m and m, from a point that is fixed (m) to one on the second link."""


def judged(cause: Cause, added: np.ndarray, site: tuple[int, ...]) -> StructureTest | None:
    """Fit a cause to pinocchio's torque with another torque added, and test what it leaves."""
    time, position, torque = recording()
    fitter = fitter_of(scene_of(time, position, torque + added), (cause,))
    none = fitter.fit(())
    candidate = next(each.candidate for each in fitter.scan(none) if site in ((), each.candidate.site))
    found = fitter.fit((candidate,), none)
    return structure_test(StructureLeft(fitter, found), none, 0, likelihood_ratio(none, found))


def between_links(stiffness: float) -> np.ndarray:
    """Give the torque of a potential 1 - cos(1.5 q2 + q3), as a bundle of cables may have."""
    position = recording()[1]
    bent = stiffness * np.sin(1.5 * position[:, 1] + position[:, 2])
    return np.column_stack([0.0 * bent, 1.5 * bent, bent])


def own_spring(stiffness: float) -> np.ndarray:
    """Give the torque of a spring on one joint."""
    added = np.zeros_like(recording()[1])
    added[:, JOINT - 1] = stiffness * recording()[1][:, JOINT - 1]
    return added


def planar_arm(seed: int, *, cables: bool) -> Mapping[str, Any]:
    """Diagnose an arm by its closed equations, with cables to its base or a spring on its second joint."""
    rng = np.random.default_rng([seed, 5])
    body, reference = second._body(rng), second._reference(rng, 0.8)
    time = np.arange(0.0, SECONDS, 1.0 / second.RATE_HZ)
    angle = np.array([reference.at(instant)[0] for instant in time])
    rate, bend = (CubicSpline(time, angle)(time, order) for order in (1, 2))
    torque = np.array([body.mass(q) @ a + body.bias(q, v) for q, v, a in zip(angle, rate, bend, strict=True)])
    torque += body.viscous * rate + body.coulomb * np.tanh(rate / 1e-3)
    torque += of_cables(angle) if cables else STIFFNESS * REACH**2 * angle * [0.0, 1.0]
    torque += 0.005 * torque.std(axis=0) * rng.normal(size=torque.shape)
    log = log_from_arrays("cables", time, angle, torque)
    found = diagnose(IdentifyRequest(second.robot(), (log,), {"bootstrap": {"draws": 0}}))["diagnosis"]
    assert isinstance(found, dict)
    return found


def of_cables(angle: np.ndarray) -> np.ndarray:
    """Give the torque against a spring from a fixed point to the second link."""
    first, last = second.LINK * np.exp(1j * angle[:, 0]), REACH * np.exp(1j * angle.sum(axis=1))
    way = first + last - FIXED
    force = STIFFNESS * (1.0 - LENGTH / np.abs(way)) * way
    return np.column_stack([(lever * np.conj(force)).real for lever in (1j * (first + last), 1j * last)])


def test_cables_to_the_base_are_no_spring_of_a_joint():
    found = planar_arm(4, cables=True)
    assert SpringCompensator.id in [each["cause"] for each in found["findings"]]
    assert all(each["confidence"] <= CONFIDENCE.doubtful for each in found["findings"])
    assert found["verdict"] == "unexplained"


def test_a_spring_of_the_same_arm_is_named():
    (found,) = planar_arm(4, cables=False)["findings"]
    assert (found["cause"], found["joints"]) == (SpringCompensator.id, [2])
    assert found["confidence"] > 0.9


def test_a_spring_of_the_joint_leaves_no_structure():
    assert judged(SpringCompensator(), own_spring(1.5), (JOINT,)) is None


def test_a_spring_that_stands_for_cables_between_links_is_doubtful():
    found = judged(SpringCompensator(), between_links(0.8), (JOINT,))
    assert found is not None
    assert found.doubts
    assert found.share > STRUCTURE_LEFT.share
    assert (found.worst, found.of) == (JOINT, "the angles of all joints")


def test_joints_without_structure_are_evidence_enough():
    time, position, torque = recording()
    late = np.array([np.interp(time - DELAY_S, time, column) for column in torque.T]).T
    spoilt = np.zeros_like(torque)
    spoilt[:, 1] = 0.2 * np.sin(position[:, 0] + position[:, 1])
    found = judged(TimeDelay(), late - torque + spoilt, ())
    assert found is not None
    assert found.worst == 2
    assert not found.doubts


@pytest.mark.parametrize("decay", [0.0, 0.2], ids=["alike", "a few count"])
def test_noise_is_no_structure(decay):
    rng = np.random.default_rng(1)
    sizes = np.exp(-decay * np.arange(FUNCTIONS))
    drawn = rng.normal(size=(DRAWS, FUNCTIONS)) * np.sqrt(sizes)
    statistics = np.array([likeliest_process(np.diag(sizes), slope).statistic for slope in drawn])
    assert np.mean(statistics > STRUCTURE_LEFT.statistic) < 2e-3
    assert np.mean(statistics > 2.7) < 0.1


def test_many_small_coefficients_are_seen_together():
    rng = np.random.default_rng(2)
    slopes = rng.normal(size=(100, FUNCTIONS)) + 1.5 * rng.normal(size=(100, FUNCTIONS))
    statistics = [likeliest_process(np.eye(FUNCTIONS), slope).statistic for slope in slopes]
    assert np.mean(np.array(statistics) > STRUCTURE_LEFT.statistic) > 0.8
