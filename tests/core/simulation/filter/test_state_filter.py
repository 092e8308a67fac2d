"""Laws of the Kalman filters' kernel: what batch least squares is, on plants where that is known."""

import numpy as np
import pytest

from tests.core.estimate.worlds import planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.reduction.base import base_model
from veritorque.core.robot.description import robot_from_description
from veritorque.core.simulation.filter.state_filter import Clock, FilterState, StateFilter, filter_of

STEP, NOISE, SPEED = 1e-3, 1e-4, 0.3
BOTH = pytest.mark.parametrize("unscented", [False, True], ids=["ekf", "srukf"])


def axle() -> tuple[StateFilter, StateFilter, int]:
    """Give both filters of a joint on which no gravity acts and no dry friction, and its offset's place."""
    row = {"type": "revolute", "alpha": 0.0, "d": 0.0, "r": 0.0, "theta_offset": 0.0}
    robot = robot_from_description({"name": "axle", "gravity": [0.0, 0.0, 0.0], "joints": [row]})
    base = base_model(standard_model(robot))
    symbols = [base.parameter(number).symbol for number in range(len(base.kept))]
    values = {"ZZ": 0.5, "FV": 2.0}
    standard = np.array([values.get(one.symbol, 0.0) for one in base.model.parameters])
    given = base, standard, np.array([NOISE**2]), Clock(STEP, 1)
    extended, unscented = (
        filter_of(*given, held=np.zeros(1, dtype=bool), unscented=both) for both in (False, True)
    )
    return extended, unscented, symbols.index("OFF")


@BOTH
def test_without_noise_of_the_torque_a_linear_plant_is_fitted_as_by_least_squares(unscented):
    own = axle()[unscented]
    size, place = len(own.reference), axle()[2]
    inertia, damping, offset = 0.5, 2.0, 0.7
    rng = np.random.default_rng(1)
    torque = 3.0 * np.sin(np.arange(400) * 0.02)
    # One row per sample: position as a linear function of (offset, first position, first speed), and 1.
    position, velocity = np.array([0.0, 1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0, 0.0])
    rows = []
    for force in torque:
        rows.append(position)
        push = np.array([-1.0, 0.0, 0.0, force])
        velocity = velocity + STEP * (push - damping * velocity) / (inertia + 0.5 * STEP * damping)
        position = position + STEP * velocity
    table = np.array(rows)
    measured = table @ [offset, 0.1, -0.2, 1.0] + NOISE * rng.normal(size=len(table))
    start, wide = np.array([0.4, 0.1, -0.1]), np.array([0.5, NOISE, SPEED])
    system = np.vstack([table[:, :3] / NOISE, np.diag(1.0 / wide)])
    right = np.concatenate([(measured - table[:, 3]) / NOISE, start / wide])
    batch = np.linalg.lstsq(system, right, rcond=None)[0]

    factor = np.zeros((size, size))
    factor[place, place] = wide[0]
    mean = np.concatenate([own.reference, start[1:]])
    mean[place] = start[0]
    state = own.started(mean, factor, np.array([SPEED]))
    nothing = np.zeros((len(torque), 1))
    _, state = own.run(state, measured[:, None], torque[:, None], nothing)
    covariance = np.linalg.solve(system.T @ system, np.eye(3))
    assert abs(state.mean[place] - batch[0]) < 1e-6
    np.testing.assert_allclose(np.linalg.norm(state.factor[:, place]), np.sqrt(covariance[0, 0]), rtol=1e-6)
    assert abs(state.mean[-2] - table[-1] @ np.append(batch, 1.0)) < 1e-8


def swinging(*, unscented: bool) -> tuple[StateFilter, FilterState, tuple[np.ndarray, ...]]:
    """Give a filter of two links with its start, and a second of motion and torque."""
    model = standard_model(planar_robot())
    truth, state = true_parameters(model), swing(2, rate_hz=1000.0, seconds=1.0)
    base = base_model(model)
    own = filter_of(
        base, truth, np.full(2, 1e-10), Clock(1e-3, 1), held=np.zeros(2, dtype=bool), unscented=unscented
    )
    mean = np.concatenate([1.01 * own.reference, state.position[0], state.velocity[0]])
    begun = own.started(mean, np.diag(0.02 * np.abs(own.reference)), np.full(2, 1e-2))
    noise = np.full((1000, 2), 0.1)
    return own, begun, (state.position, model.torque(truth, state), noise)


@BOTH
def test_pieces_are_filtered_as_the_whole(unscented):
    own, begun, samples = swinging(unscented=unscented)
    missed, whole = own.run(begun, *samples)
    parts, state = [], begun
    for piece in (slice(0, 1), slice(1, 400), slice(400, None)):
        part, state = own.run(state, *(series[piece] for series in samples))
        parts.append(part)
    np.testing.assert_array_equal(np.vstack(parts), missed)
    np.testing.assert_array_equal(state.factor, whole.factor)
    np.testing.assert_array_equal(state.mean, whole.mean)


@BOTH
def test_the_factor_stays_triangular_and_what_is_known_of_parameters_only_grows(unscented):
    own, state, samples = swinging(unscented=unscented)
    size = len(own.reference)
    for begin in range(0, 1000, 200):
        before = state.factor[:size, :size].T @ state.factor[:size, :size]
        _, state = own.run(state, *(series[begin : begin + 200] for series in samples))
        assert np.array_equal(state.factor, np.triu(state.factor))
        after = state.factor[:size, :size].T @ state.factor[:size, :size]
        scale = np.sqrt(np.outer(np.diag(before), np.diag(before)))
        assert np.linalg.eigvalsh((before - after) / scale)[0] > -1e-12


def test_drift_adds_its_variance_and_nothing_else():
    _, state, _ = swinging(unscented=False)
    drifted = state.drifted(np.arange(13.0))
    added = drifted.factor.T @ drifted.factor - state.factor.T @ state.factor
    np.testing.assert_allclose(added, np.diag([*np.arange(13.0) ** 2, 0.0, 0.0, 0.0, 0.0]), atol=1e-12)
