"""A push on an arm that stands is found with its time and force; what does not come and go is none."""

import numpy as np
import pytest

from tests.core.diagnosis.scenes import bodies_of_skew_arm, scene_of, skew_arm
from tests.tools import Motion, pinocchio_torque
from tests.truths.change import pushed, torque_of_unit_push
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
SCATTER = 0.6e-3


def standing(*, rests=1, parked=False, slowest=0.0):
    """Move three joints, but for a stand of four seconds in every twenty, with friction and little noise.

    A parked joint is held all the time; its encoder trembles by a microradian.
    """
    seconds = 12.0 * rests + 8.0
    time = np.arange(0.0, seconds, 1.0 / RATE_HZ)
    into = time % 12.0
    pace = np.clip(np.minimum(into, 8.0 - into), slowest, 1.0)
    way = np.cumsum(pace) / RATE_HZ
    rng = np.random.default_rng(7)
    position = 0.8 * np.column_stack([np.sin(1.9 * way), np.cos(2.6 * way), np.sin(3.4 * way + 1.0)])
    if parked:
        position[:, 2] = 0.4
    velocity = np.gradient(position, 1.0 / RATE_HZ, axis=0)
    motion = Motion(position, velocity, np.gradient(velocity, 1.0 / RATE_HZ, axis=0))
    torque = pinocchio_torque(skew_arm(), bodies_of_skew_arm(), motion) + COULOMB * np.sign(velocity)
    torque += 0.05 * rng.normal(size=torque.shape)
    return log_from_arrays("standing", time, position + 1e-6 * rng.normal(size=position.shape), torque)


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
    unit = torque_of_unit_push(whole_rows(standing()), skew_arm(), PUSH)
    assert size["force"].value == pytest.approx(TORQUE / np.abs(unit).max(), rel=0.05)
    assert size["force"].standard_deviation < 0.05 * size["force"].value
    assert found.p_value < 1e-9


def test_two_pushes_in_one_log_are_one_finding():
    once = pushed(standing(rests=2), skew_arm(), PUSH, TORQUE)
    (found,) = found_in(pushed(once, skew_arm(), (21.0, 22.0), 1.5 * TORQUE))
    size = {one.name: one.value for one in found.quantities}
    assert (size["start_1"], size["start_2"]) == pytest.approx((PUSH[0], 21.0), abs=0.25)
    assert size["force"] == max(size["force_1"], size["force_2"])


def test_a_push_is_found_though_a_joint_is_parked():
    assert len(found_in(pushed(standing(parked=True), skew_arm(), PUSH, TORQUE))) == 1


def test_an_arm_that_stands_by_itself_is_not_pushed():
    assert found_in(standing()) == ()


def test_what_friction_can_hold_is_no_push():
    assert found_in(pushed(standing(), skew_arm(), PUSH, 1.5 * COULOMB)) == ()


def test_a_brake_that_takes_the_torque_is_no_push():
    log = with_torque(standing(), lambda time: -TORQUE * ((time > PUSH[0]) & (time < STAND[1])))
    assert found_in(log) == ()


@pytest.mark.parametrize("released", [11.9, 12.0])
def test_a_brake_that_opens_as_the_arm_begins_to_move_is_no_push(released):
    """It held the arm all the time before; the torque of the drives does not return."""
    log = standing()
    held = with_torque(log, lambda time: np.where((time > STAND[0]) & (time < released), -TORQUE, 0.0))
    assert found_in(held) == ()


def test_slow_motion_is_no_stand_however_stamps_scatter():
    """Speeds are mostly noise then, and a tenth of the usual speed is little beside it."""
    rows, rng = whole_rows(pushed(standing(slowest=0.1), skew_arm(), PUSH, TORQUE)), np.random.default_rng(3)
    stamps = np.maximum.accumulate(rows.time + rng.exponential(SCATTER, len(rows.time)))
    stamps += 1e-6 * np.arange(len(stamps))
    assert found_in(log_from_arrays("scattered", stamps, rows.position, rows.torque)) == ()
