"""Every effect alone: nothing at size zero, on the joint that it says, with the sign that it says."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tests.plant.cases import World, draw_world
from tests.plant.effects.drive import TorqueGain, TorqueOffsetDrift
from tests.plant.effects.effect import Effect
from tests.plant.effects.encoder import EncoderOffset
from tests.plant.effects.friction import Asymmetric, LoadDependent, Presliding
from tests.plant.effects.registry import CLASSES, EFFECTS, FOREIGN, PARAMETERS
from tests.plant.effects.surroundings import PayloadChange, SpringCompensator
from tests.plant.effects.timing import DroppedSamples, TimeDelay, TorqueFilterLag
from tests.plant.effects.transmission import JointElasticity
from tests.plant.mechanism import build, inverse
from tests.plant.sensors import counted

EVERY = EFFECTS | FOREIGN


@cache
def world(robot: str = "planar-3", seconds: float = 6.0) -> World:
    return draw_world(np.random.default_rng(11), 11, robot=robot, noise="white", duration=seconds)


def drawn(cause: str, robot: str = "planar-3") -> Effect:
    there = world(robot)
    return EVERY[cause].draw(np.random.default_rng(2), there.arm, there.steering)


def test_every_cause_of_the_enumeration_can_be_hidden():
    assert set(CLASSES) == set(PARAMETERS) | set(FOREIGN)
    assert all(PARAMETERS.values())


def test_every_position_in_the_drawing_order_belongs_to_one_effect():
    """Cases are drawn by position: a new effect takes the next free one."""
    assert [kind.draw_order for kind in EFFECTS.values()] == list(range(1, len(EFFECTS) + 1))


@pytest.mark.parametrize("cause", EFFECTS)
def test_the_hidden_numbers_are_named_as_the_document_names_them(cause):
    names = {one.name for one in drawn(cause).truth()}
    extra = {f"{end}_{number}" for end in ("start", "end") for number in range(1, 5)} | {"alpha", "d", "r"}
    assert PARAMETERS[cause] - {"time_constant"} <= names <= PARAMETERS[cause] | extra


@pytest.mark.parametrize("cause", [name for name in EVERY if name != "joint_elasticity"])
def test_an_effect_of_size_zero_leaves_nothing(cause):
    effect = drawn(cause)
    if cause == "encoder_offset":  # in a plane, that of any later joint is a turn of the links it carries
        effect = replace(effect, joints=(1,))
    if cause == "kinematic_error":  # in a plane, lengths are mostly absorbed
        effect = replace(effect, entry="alpha", error=0.2)
    there = world()
    left = there.residue(effect.scaled(0.0)).strength.max()
    reached = there.residue(effect).strength.max()
    # Backlash of no width is still a gear with stiff contact, whose own softness shows a little.
    assert left < (0.3 if effect.splits else 0.02)
    assert reached > 3.0 * left


def test_an_elastic_joint_shows_less_the_stiffer_it_is():
    effect = replace(drawn("joint_elasticity"), joints=(3,))
    assert isinstance(effect, JointElasticity)
    soft, stiff = (world().residue(effect.scaled(factor)).strength.max() for factor in (20.0, 1.0))
    assert stiff < 0.5 * soft


@pytest.mark.parametrize("cause", ["friction_stribeck", "torque_ripple", "torque_gain", "cable_force"])
def test_an_effect_shows_most_where_it_sits_or_below(cause):
    effect = replace(drawn(cause), joints=(3,))
    strength = world(seconds=8.0).residue(effect).strength
    assert np.argmax(strength) + 1 <= 3
    assert strength.max() > 0.05


def test_a_delay_shows_the_torque_of_earlier():
    ideal = world().signals(())
    late = world().signals((TimeDelay((1, 2, 3), 0.004),))
    np.testing.assert_allclose(late.torque[1:], ideal.torque[:-1], atol=1e-9)


def test_a_lag_follows_a_slow_torque_by_its_time_constant():
    ideal, late = world().signals(()), world().signals((TorqueFilterLag((1, 2, 3), 0.02),))
    moving = slice(250, None)
    shifted = np.interp(ideal.time - 0.02, ideal.time, ideal.torque[:, 0])
    near = np.sqrt(np.mean((late.torque[moving, 0] - shifted[moving]) ** 2))
    far = np.sqrt(np.mean((ideal.torque[moving, 0] - shifted[moving]) ** 2))
    assert near < 0.3 * far


@pytest.mark.parametrize("time_constant", [0.0, 1e-4, 0.002, 0.02])
def test_a_lag_is_late_on_a_ramp_by_its_time_constant_and_by_no_part_of_a_step(time_constant):
    plain = world().signals(())
    ramp = plain.with_torque(np.tile(plain.fine_time[:, None], (1, 3)))
    late = TorqueFilterLag((1, 2, 3), time_constant).sense(ramp, np.random.default_rng(0))
    np.testing.assert_allclose((ramp.torque - late.torque)[-1], time_constant, rtol=1e-6, atol=1e-12)


def test_a_wrong_gain_a_drift_and_an_offset_are_logged_as_they_are_documented():
    ideal = world().signals(())
    gained = world().signals((TorqueGain((2,), 0.1),))
    drifted = world().signals((TorqueOffsetDrift((1,), 0.5, 0.0),))
    offset = world().signals((EncoderOffset((3,), 0.05),))
    np.testing.assert_allclose(gained.torque[:, 1], 1.1 * ideal.torque[:, 1])
    assert drifted.torque[-1, 0] - ideal.torque[-1, 0] == pytest.approx(0.5)
    np.testing.assert_allclose(offset.position[:, 2], ideal.position[:, 2] + 0.05)


def rigid_torque(there: World, signals: object) -> np.ndarray:
    arm = there.arm
    state = (signals.position, signals.velocity, signals.acceleration)
    drives = arm.rotor_inertia * signals.acceleration + arm.viscous * signals.velocity + arm.offset
    return inverse(build(arm), state) + drives


@pytest.mark.parametrize("cause", ["torque_gain", "torque_gain_nonlinear", "torque_offset_drift"])
@pytest.mark.parametrize("late", ["time_delay", "torque_filter_lag", "timestamp_jitter"])
def test_a_wrong_channel_and_a_late_one_are_both_logged_in_whatever_order_they_are_hidden(cause, late):
    one, other = (
        EVERY[name].draw(np.random.default_rng(5), world().arm, world().steering) for name in (cause, late)
    )
    seen = {
        effects: world().signals(effects).torque
        for effects in [(), (one,), (other,), (one, other), (other, one)]
    }
    apart = (seen[one,] - seen[()]) + (seen[other,] - seen[()])
    for both in ((one, other), (other, one)):
        missed = seen[both] - seen[()] - apart
        for single in ((one,), (other,)):
            assert np.linalg.norm(missed) < 0.2 * np.linalg.norm(seen[single] - seen[()])


def test_the_effects_torque_is_what_the_drive_has_to_give_more():
    there = world()
    for effect, joint, law in (
        (SpringCompensator((2,), 3.0, 0.1), 1, lambda q, dq: 3.0 * (q - 0.1)),
        (Asymmetric((1,), 0.4, 3.0), 0, lambda q, dq: 0.4 * np.abs(dq)),
    ):
        signals = there.signals((effect,))
        moving = np.abs(signals.direction[:, joint]) > 0.999
        friction = there.arm.coulomb[joint] * np.sign(signals.velocity[:, joint])
        more = (signals.torque - rigid_torque(there, signals))[:, joint] - friction
        wanted = law(signals.position[:, joint], signals.velocity[:, joint])
        error = np.abs(more - wanted)[moving]
        assert np.percentile(error, 98) < 0.02 * np.abs(wanted).max()


def test_friction_grows_with_the_load_that_moves_the_robot():
    there = world()
    signals = there.signals((LoadDependent((1,), 0.2),))
    moving = np.abs(signals.direction[:, 0]) > 0.999
    rigid = rigid_torque(there, signals)[:, 0]
    load = rigid - there.arm.offset[0] - there.arm.viscous[0] * signals.velocity[:, 0]
    more = (signals.torque[:, 0] - rigid) * np.sign(signals.velocity[:, 0]) - there.arm.coulomb[0]
    error = np.abs(more[moving] - 0.2 * np.abs(load[moving]))
    assert np.percentile(error, 95) < 0.02 * np.abs(load).max()


def test_presliding_friction_is_below_its_level_after_a_reversal_and_reaches_it():
    there = world()
    signals = there.signals((Presliding((1,), 0.02),))
    friction = (signals.torque - rigid_torque(there, signals))[:, 0] / there.arm.coulomb[0]
    assert np.abs(friction).max() == pytest.approx(1.0, abs=0.02)
    assert np.mean(np.abs(friction) < 0.9) > 2.0 * np.mean(
        np.abs(there.clean.sampled().direction[:, 0]) < 0.9
    )


def test_a_payload_changes_nothing_before_it_is_taken_up():
    there = world()
    loaded = there.signals((PayloadChange((3,), 0.5, 0.2, 0.0, 0.0, 4.0),))
    clean = there.signals(())
    before = clean.time < 3.99
    np.testing.assert_allclose(loaded.torque[before], clean.torque[before], atol=1e-6)
    assert np.abs(loaded.torque[~before] - clean.torque[~before]).max() > 0.5


def test_dropped_rows_repeat_the_row_before_them():
    signals = world().signals((DroppedSamples((1, 2, 3), 0.1),))
    repeated = np.all(np.diff(counted(signals), axis=0) == 0.0, axis=1) & (np.diff(signals.kept) == 0)
    assert 0.05 < np.mean(repeated) < 0.15
