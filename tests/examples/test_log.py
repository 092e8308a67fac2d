"""The shipped log: within the arm's limits, reproducible, and made from the truth that stands beside it."""

import json

import numpy as np
import pinocchio as pin
import pytest

from examples.yumi import arm, make_log
from examples.yumi.excitation import DURATION, Excitation, window
from examples.yumi.plant import pinocchio_model
from veritorque.core.robot.builtin import builtin_robot

LOG = arm.HERE / "log.csv"
TRUTH = json.loads((arm.HERE / "truth.json").read_text(encoding="utf-8"))
HEADER = LOG.read_text(encoding="utf-8").partition("\n")[0].split(",")
TABLE = np.loadtxt(LOG, delimiter=",", skiprows=1)
POSITION, TORQUE = TABLE[:, 1:8], TABLE[:, 8:]
ONE_COUNT = arm.ENCODER_STEP + 1.1e-6
"""A position that lies between two counts may fall to either on another processor, rad."""


def stored_excitation():
    motion = TRUTH["motion"]
    return Excitation(*(np.array(motion[name]) for name in ("centre", "sine", "cosine")))


@pytest.fixture(scope="module")
def motion():
    return make_log.simulate(excitation=stored_excitation(), until=4.0)


def test_the_log_has_the_default_names_and_half_a_minute_at_250_hertz():
    assert ["time", *(f"{kind}_{n}" for kind in ("q", "tau") for n in range(1, 8))] == HEADER
    np.testing.assert_allclose(TABLE[:, 0], np.arange(7500) / 250.0, atol=1e-12)
    assert LOG.stat().st_size < 1_500_000


def test_the_log_stays_within_the_joint_limits():
    assert (POSITION >= arm.LOWER).all()
    assert (POSITION <= arm.UPPER).all()
    velocity = np.gradient(POSITION, 1.0 / arm.RATE_HZ, axis=0)
    assert (np.abs(velocity) <= arm.MAX_VELOCITY).all()


def test_the_encoders_count():
    counts = POSITION / arm.ENCODER_STEP
    assert np.abs(counts - np.round(counts)).max() * arm.ENCODER_STEP <= 0.51e-6  # the file's last digit


def test_the_motion_starts_and_ends_at_rest():
    value, slope, bend = window(np.array([0.0, DURATION]))
    assert not value.any()
    assert not slope.any()
    assert not bend.any()


def test_simulating_again_gives_the_first_rows_of_the_log(motion):
    # The noise of the first rows depends on how many samples are drawn, so the torque is compared within it.
    columns = make_log.measure(motion)
    rows = len(motion.time)
    again = np.column_stack([columns[f"q_{n}"] for n in range(1, 8)])
    np.testing.assert_allclose(again, POSITION[:rows], atol=ONE_COUNT)
    residual = (TORQUE[:rows] - motion.torque).std(axis=0)
    noise = np.hypot(make_log.WHITE_NOISE, make_log.COLOURED_NOISE)
    np.testing.assert_allclose(residual, noise, rtol=0.1)  # 1,000 samples: three deviations are 0.07


@pytest.mark.slow
def test_simulating_all_of_it_from_the_seed_gives_the_same_file():
    motion = make_log.simulate(TRUTH["seed"])
    np.testing.assert_allclose(motion.excitation.sine, TRUTH["motion"]["sine"], rtol=1e-9)
    columns = make_log.measure(motion, TRUTH["noise_seed"])
    again = np.column_stack(list(columns.values()))
    np.testing.assert_allclose(again[:, 1:8], POSITION, atol=ONE_COUNT)
    np.testing.assert_allclose(again[:, 8:], TORQUE, atol=1e-3)


def test_the_noiseless_torque_is_inverse_dynamics_plus_friction_of_the_truth(motion):
    model = pinocchio_model()
    states = zip(motion.position, motion.velocity, motion.acceleration, strict=True)
    rigid = np.array([pin.rnea(model, model.createData(), *state) for state in states])
    friction = motion.torque - rigid - arm.OFFSET
    law = arm.VISCOUS * motion.velocity + arm.COULOMB * np.sign(motion.velocity)
    moving = np.abs(motion.velocity) > 0.01
    assert moving.mean() > 0.9
    # 1e-3 N m: the step predicts the Coriolis velocity, which is second-order accurate.
    assert np.abs(friction - law)[moving].max() < 1e-3
    assert (np.abs(motion.friction) <= arm.COULOMB + arm.VISCOUS * np.abs(motion.velocity) + 1e-9).all()


def test_half_the_step_gives_the_same_motion_to_ten_encoder_counts(motion, monkeypatch):
    monkeypatch.setattr(make_log, "STEPS_PER_SAMPLE", 2 * make_log.STEPS_PER_SAMPLE)
    finer = make_log.simulate(excitation=stored_excitation(), until=2.0)
    rows = len(finer.time)
    assert np.abs(finer.position - motion.position[:rows]).max() < 10 * arm.ENCODER_STEP


def test_one_motion_gives_as_many_noise_draws_as_wanted(motion):
    first, again, other = (make_log.measure(motion, seed) for seed in (5, 5, 6))
    assert np.array_equal(first["tau_1"], again["tau_1"])
    assert not np.array_equal(first["tau_1"], other["tau_1"])
    assert np.array_equal(first["q_1"], other["q_1"])


def test_the_noise_is_one_to_two_percent_of_the_torque_range():
    percent = TRUTH["sensors"]["noise_of_range_percent"]
    assert all(1.0 <= value <= 2.0 for value in percent)


def test_the_description_beside_the_log_is_the_built_in_robot():
    description = json.loads((arm.HERE / "robot.json").read_text(encoding="utf-8"))
    assert description == arm.robot_description()
    robot = builtin_robot("yumi-left")
    model = pinocchio_model()
    for link, placement in zip(robot.links, list(model.jointPlacements)[1:], strict=True):
        np.testing.assert_allclose(link.translation, placement.translation, atol=1e-12)
        np.testing.assert_allclose(link.rotation, placement.rotation, atol=1e-12)
    np.testing.assert_allclose(robot.gravity, description["gravity"])
