"""The second shipped log: made from the truth beside it, with two effects that no standard model has."""

import json
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from examples.yumi import arm, make_log
from examples.yumi.excitation import Excitation
from examples.yumi.hidden import EFFECTS, NOTHING, TWO_EFFECTS
from examples.yumi.plant import pinocchio_model

LOG = arm.HERE / "hidden_log.csv"
TRUTH = json.loads((arm.HERE / "hidden_truth.json").read_text(encoding="utf-8"))
TABLE = np.loadtxt(LOG, delimiter=",", skiprows=1)
POSITION, TORQUE = TABLE[:, 1:8], TABLE[:, 8:]


def simulated(until, hidden=TWO_EFFECTS):
    parts = (np.array(TRUTH["motion"][name]) for name in ("centre", "sine", "cosine"))
    return make_log.simulate(excitation=Excitation(*parts), until=until, hidden=hidden)


@pytest.fixture(scope="module")
def motion():
    return simulated(4.0)


def unmodelled(motion):
    """Give what the standard model leaves at its true parameters, N m, and where joints move."""
    model = pinocchio_model()
    states = zip(motion.position, motion.velocity, motion.acceleration, strict=True)
    rigid = np.array([pin.rnea(model, model.createData(), *state) for state in states])
    left = motion.torque - rigid - arm.OFFSET - arm.VISCOUS * motion.velocity
    return left - arm.COULOMB * np.sign(motion.velocity), np.abs(motion.velocity) > 0.01


def test_the_log_is_as_large_as_the_first_and_has_its_names():
    with (arm.HERE / "log.csv").open(encoding="utf-8") as first, LOG.open(encoding="utf-8") as second:
        assert first.readline() == second.readline()
    assert TABLE.shape == (7500, 15)
    assert LOG.stat().st_size < 1_500_000


def test_the_log_stays_within_the_joint_limits():
    assert (POSITION >= arm.LOWER).all()
    assert (POSITION <= arm.UPPER).all()
    assert (np.abs(np.gradient(POSITION, 1.0 / arm.RATE_HZ, axis=0)) <= arm.MAX_VELOCITY).all()


def test_the_truth_names_what_is_hidden_and_otherwise_the_first_logs_robot():
    first = json.loads((arm.HERE / "truth.json").read_text(encoding="utf-8"))
    assert TRUTH["hidden"] == EFFECTS
    assert TRUTH["standard_parameters"] == first["standard_parameters"]
    assert "hidden" not in first


def test_simulating_again_gives_the_first_rows_of_the_log(motion):
    rows = len(motion.time)
    assert np.abs(motion.position - POSITION[:rows]).max() < 2.0 * arm.ENCODER_STEP
    noise = np.hypot(make_log.WHITE_NOISE, make_log.COLOURED_NOISE)
    np.testing.assert_allclose((TORQUE[:rows] - motion.torque).std(axis=0), noise, rtol=0.1)


def test_the_torque_of_joint_4_ripples_as_the_truth_says(motion):
    (effect,) = (one["parameters"] for one in TRUTH["hidden"] if one["cause"] == "torque_ripple")
    left, moving = unmodelled(motion)
    wave = effect["amplitude"] * np.cos(effect["harmonic"] * motion.position[:, 3] + effect["phase"])
    # 1e-3 N m: the step predicts the Coriolis velocity, which is second-order accurate.
    assert np.abs(left[:, 3] - wave)[moving[:, 3]].max() < 1e-3


def test_the_friction_of_joint_2_grows_with_the_torque_through_its_gear_as_the_truth_says(motion):
    (effect,) = (one["parameters"] for one in TRUTH["hidden"] if one["cause"] == "friction_load_dependent")
    left, moving = unmodelled(motion)
    model = pinocchio_model()
    model.armature = np.zeros(arm.JOINTS)
    states = zip(motion.position, motion.velocity, motion.acceleration, strict=True)
    load = np.array([pin.rnea(model, model.createData(), *state) for state in states])[:, 1]
    law = effect["load_coefficient"] * np.abs(load) * np.sign(motion.velocity[:, 1])
    assert np.std(law) > 0.3
    # 0.01 N m: the level follows the load of the step before, a quarter of a millisecond ago.
    assert np.abs(left[:, 1] - law)[moving[:, 1]].max() < 1e-2


def test_nothing_is_hidden_on_the_other_joints(motion):
    left, moving = unmodelled(motion)
    others = [0, 2, 4, 5, 6]
    assert np.abs(left * moving)[:, others].max() < 1e-3


def test_hiding_nothing_gives_the_motion_of_the_described_arm():
    alone = replace(TWO_EFFECTS, load_coefficient=np.zeros(7), amplitude=np.zeros(7))
    one, other = simulated(0.5, NOTHING), simulated(0.5, alone)
    assert np.array_equal(one.position, other.position)
