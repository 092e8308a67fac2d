"""A push on an arm that stands is found with its time and force; what does not come and go is none."""

import numpy as np
import pytest

from tests.core.diagnosis.scenes import bodies_of_skew_arm, scene_of, skew_arm
from tests.tools import Motion, pinocchio_torque
from tests.truths.change import pushed
from veritorque.core.diagnosis.checks.contact_at_rest import contacts_at_rest
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays

STAND = (8.0, 12.0)
PUSH = (9.0, 10.5)
TORQUE = 30.0
COULOMB = 3.0
RATE_HZ = 250.0


def standing():
    """Move three joints for 20 s, but for a stand of four, with Coulomb friction and noise of 0.05 N m."""
    time = np.arange(0.0, 20.0, 1.0 / RATE_HZ)
    moves = (time < STAND[0]) | (time > STAND[1])
    way = np.cumsum(moves * np.minimum(1.0, np.minimum(np.abs(time - 8.0), np.abs(time - 12.0)))) / RATE_HZ
    position = 0.8 * np.column_stack([np.sin(1.9 * way), np.cos(2.6 * way), np.sin(3.4 * way + 1.0)])
    velocity = np.gradient(position, 1.0 / RATE_HZ, axis=0)
    motion = Motion(position, velocity, np.gradient(velocity, 1.0 / RATE_HZ, axis=0))
    torque = pinocchio_torque(skew_arm(), bodies_of_skew_arm(), motion) + COULOMB * np.sign(velocity)
    noise = np.random.default_rng(7).normal(size=torque.shape)
    return log_from_arrays("standing", time, position, torque + 0.05 * noise)


def found_in(log):
    rows = whole_rows(log)
    model = standard_model(skew_arm(), ("rigid_body", "coulomb"))
    values = np.zeros(len(model.parameters))
    values[: bodies_of_skew_arm().size] = bodies_of_skew_arm().ravel()
    values[[place for place, one in enumerate(model.parameters) if one.symbol == "FC"]] = COULOMB
    return contacts_at_rest(
        scene_of(rows.time, rows.position, rows.torque).dataset, Prediction(model, values)
    )


def with_torque(log, change):
    rows = whole_rows(log)
    return log_from_arrays(log.name, rows.time, rows.position, rows.torque + change(rows.time)[:, None])


def test_a_push_is_found_with_its_time_and_force():
    (found,) = found_in(pushed(standing(), skew_arm(), PUSH, TORQUE))
    size = {one.name: one for one in found.quantities}
    assert size["start_1"].value == pytest.approx(PUSH[0], abs=0.25)
    assert size["end_1"].value == pytest.approx(PUSH[1], abs=0.25)
    whole = whole_rows(standing())
    change = whole_rows(pushed(standing(), skew_arm(), PUSH, TORQUE)).torque - whole.torque
    assert np.abs(change).max() == pytest.approx(TORQUE, rel=0.01)
    assert size["force"].value > 3.0 * size["force"].standard_deviation
    assert found.p_value < 1e-9


def test_an_arm_that_stands_by_itself_is_not_pushed():
    assert found_in(standing()) == ()


def test_what_friction_can_hold_is_no_push():
    assert found_in(pushed(standing(), skew_arm(), PUSH, 1.5 * COULOMB)) == ()


def test_a_brake_that_takes_the_torque_is_no_push():
    log = with_torque(standing(), lambda time: -TORQUE * ((time > PUSH[0]) & (time < STAND[1])))
    assert found_in(log) == ()
