"""What simulated columns are for: arms that stick, and noisy encoders, in an engine that is not ours."""

from collections.abc import Mapping
from functools import cache

import numpy as np
import pytest

from tests.plant.cases import World, draw_world
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan, dense
from veritorque.core.signals.state import MotionState
from veritorque.core.study import IdentifyRequest, identify_in_full

SEED, STATES = 708, 2000


@cache
def world(robot: str) -> World:
    """Draw an arm that sticks at its reversals."""
    rng = np.random.default_rng([SEED, 0])
    return draw_world(rng, SEED, robot=robot, noise="white", duration=10.0, rate_hz=1000.0)


def truth(robot: str, names: list[str]) -> np.ndarray:
    """Give the standard parameters of those names: bodies in the order of the links, drives by name."""
    arm = world(robot).arm
    parts = (("IA", arm.rotor_inertia), ("FV", arm.viscous), ("FC", arm.coulomb), ("OFF", arm.offset))
    drives = {f"{symbol}{joint + 1}": part[joint] for symbol, part in parts for joint in range(len(part))}
    bodies = iter(arm.bodies.ravel())
    return np.array([float(drives[name]) if name in drives else float(next(bodies)) for name in names])


def torque_error(robot: str, encoder_deg: float, estimator: str, draws: int = 1, **options: object) -> float:
    """Give the RMS error over draws of noise."""
    errors = [drawn_error(robot, encoder_deg, estimator, seed, options) for seed in range(draws)]
    return float(np.sqrt(np.mean(np.square(errors))))


def drawn_error(
    robot: str, encoder_deg: float, estimator: str, seed: int, options: Mapping[str, object]
) -> float:
    """Give the error of the torque predicted for motions that were not seen, % of its RMS, joints alike."""
    own = world(robot)
    signals, rng = own.signals(()), np.random.default_rng(seed)
    position = signals.position + np.deg2rad(encoder_deg) * rng.normal(size=signals.position.shape)
    torque = signals.torque + 0.02 * own.noise_rms * rng.normal(size=signals.torque.shape)
    log = log_from_arrays("noisy", signals.time, position, torque)
    asked = {"estimator": estimator, "bootstrap": {"draws": 0}, **options}
    found = identify_in_full(IdentifyRequest(own.arm.robot, (log,), asked)).estimate.base
    model = standard_model(own.arm.robot)
    base = base_model(model)
    true = base.base_of(truth(robot, [parameter.name for parameter in model.parameters]))
    velocity = np.gradient(signals.position, signals.time, axis=0)
    acceleration = np.gradient(velocity, signals.time, axis=0)
    joints = len(own.arm.viscous)
    drawn = rng.normal(size=(2, STATES, joints))
    state = MotionState(
        rng.uniform(-1.5, 1.5, (STATES, joints)),
        drawn[0] * velocity.std(axis=0),
        drawn[1] * acceleration.std(axis=0),
    )
    columns = dense(ColumnPlan(model, base.kept), state)
    missed, whole = (np.reshape(columns @ part, (STATES, -1)) for part in (found - true, true))
    return float(100.0 * np.sqrt(np.mean((missed / np.sqrt(np.mean(whole**2, axis=0))) ** 2)))


@pytest.mark.parametrize("robot", ["planar-2", "ur10e"])
@pytest.mark.parametrize("encoder_deg", [1e-3, 1e-2])
def test_simulated_columns_predict_better_than_measured_ones_where_joints_stick(robot, encoder_deg):
    least, simulated = (torque_error(robot, encoder_deg, name, draws=3) for name in ("sdp", "didim"))
    assert simulated < min(0.7 * least, 0.3)


def test_instruments_remove_most_of_the_bias_of_noisy_columns_in_a_wide_band():
    wide = {"filter": {"cutoff_hz": 40.0}}
    least, instrumental = (torque_error("planar-2", 1e-2, name, **wide) for name in ("sdp", "iv"))
    assert least > 2.0
    assert instrumental < 0.5 * least


def test_instruments_do_no_harm_where_the_columns_do_not_err():
    least, instrumental = (torque_error("planar-2", 1e-3, name) for name in ("sdp", "iv"))
    assert instrumental < 1.15 * least
