"""The size of a finding in each log: a spring that one of two logs has is missing in the other."""

import numpy as np
import pytest

from tests.core.diagnosis.scenes import Scene, bodies_of_skew_arm, fitter_of, recording, skew_arm
from veritorque.core.diagnosis.causes.spring_compensator import SpringCompensator
from veritorque.core.diagnosis.checks.between_logs import BetweenLogs, SizeInLog
from veritorque.core.diagnosis.dataset.dataset import build_dataset
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.log.reader import log_from_arrays

JOINT, STIFFNESS = 2, 1.5


def least_size(*stiffness: float) -> SizeInLog | None:
    """Find one spring in logs that have springs of their own."""
    logs = []
    for number, own in enumerate(stiffness):
        time, position, torque = recording()
        torque[:, JOINT - 1] += own * position[:, JOINT - 1]
        torque += 0.05 * np.random.default_rng(number).normal(size=torque.shape)
        logs.append(log_from_arrays(f"run {number}", time, position, torque))
    model = standard_model(skew_arm())
    dataset = build_dataset(model, tuple(logs), held_out=frozenset({(0, 4)}), blocks=5)
    bodies = Prediction(standard_model(skew_arm(), ("rigid_body",)), bodies_of_skew_arm().ravel())
    fitter = fitter_of(Scene(dataset, bodies), (SpringCompensator(),))
    (spring,) = (one for one in fitter.candidates if one.site == (JOINT,))
    return BetweenLogs(fitter, fitter.fit((spring,), fitter.fit(()))).least_size(0)


def test_a_spring_of_all_logs_is_as_large_in_each():
    found = least_size(STIFFNESS, STIFFNESS)
    assert abs(found.size - 1.0) < 3.0 * found.deviation
    assert found.deviation < 0.1
    assert not found.is_missing


@pytest.mark.parametrize("stiffness", [(STIFFNESS, 0.0), (0.0, STIFFNESS), (0.0, STIFFNESS, STIFFNESS)])
def test_a_spring_of_one_log_is_missing_in_the_other(stiffness):
    found = least_size(*stiffness)
    assert found.is_missing
    assert found.log == f"run {stiffness.index(0.0)}"
    assert abs(found.size) < max(3.0 * found.deviation, 0.05)
    assert found.log in found.evidence.statement


def test_of_one_log_there_is_nothing_to_compare():
    assert least_size(STIFFNESS) is None
