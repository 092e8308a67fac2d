"""Let no correction be sure that holds in some parts of a log alone, or that a few seconds ask for."""

import numpy as np
import pytest

from tests.conflicts.score import PLAIN
from tests.core.conflicts.skew_arm import skew_arm
from tests.core.estimate.worlds import true_parameters
from tests.plant.cases import draw_clean
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.signals.state import MotionState
from veritorque.core.study import IdentifyRequest, identify


def rough_friction(rows, joint):
    """Give dry friction that varies with the position, N m."""
    angle = rows.position[:, joint]
    return 3.0 * np.tanh(np.gradient(angle, rows.time) / 0.05) * (1.0 + 0.5 * np.sin(3.0 * angle))


def spring(rows, joint):
    """Give a spring, N m."""
    angle = rows.position[:, joint]
    return 3.0 * (angle - angle.mean() + 0.5) / angle.std()


def wall(rows, joint):
    """Give an elastic wall in the upper part of the range, N m."""
    angle = rows.position[:, joint]
    return 8.0 * np.maximum(angle - np.quantile(angle, 0.6), 0.0) / np.ptp(angle)


def push(rows, _joint):
    """Give a constant load in the second half of the log, N m."""
    return 2.0 * (rows.time > 0.5 * rows.time[-1])


def named(robot, seed, duration, *effects, reversed_joint=None):
    """Name what is surely wrong with a sound arm that has effects as large as its torques or larger."""
    case = draw_clean(seed, noise="white", robot=robot, duration=duration)
    rows = whole_rows(case.log)
    torque = rows.torque.copy()
    for effect, joint in effects:
        torque[:, joint] += torque[:, joint].std() * effect(rows, joint)
    if reversed_joint is not None:
        torque[:, reversed_joint] *= -1.0
    log = log_from_arrays("log", rows.time, rows.position, torque)
    document = identify(IdentifyRequest(case.believed, (log,), PLAIN))
    return [(row["conflict"], *row["joints"]) for row in document["conflicts"] if row["confidence"] > 0.5]


@pytest.mark.parametrize(
    ("robot", "seed", "duration", "effects"),
    [
        ("planar-2", 4207, 9.0, [(wall, 1), (rough_friction, 0)]),
        ("planar-2", 4209, 9.0, [(push, 0), (wall, 1)]),
        ("planar-3", 4256, 5.0, [(spring, 1), (push, 2)]),
        ("planar-2", 4106, 3.5, [(rough_friction, 0), (spring, 1)]),
        ("planar-2", 4115, 3.5, [(rough_friction, 0), (spring, 1)]),
    ],
)
def test_strong_effects_in_a_short_log_are_no_wrong_set_up(robot, seed, duration, effects):
    assert named(robot, seed, duration, *effects) == []


@pytest.mark.parametrize(("robot", "seed"), [("planar-2", 4207), ("planar-3", 4256)])
def test_a_reversed_torque_is_named_in_as_short_a_log(robot, seed):
    assert named(robot, seed, 9.0, reversed_joint=1) == [("torque_sign", 2)]


def one_after_the_other(seed):
    """Move three joints in turn, for ten seconds each: states, and the torques that they take."""
    rng, time = np.random.default_rng(seed), np.arange(0.0, 30.0, 0.01)
    position = np.tile(rng.uniform(-0.6, 0.6, 3), (len(time), 1))
    for joint in range(3):
        share = np.clip(time / 10.0 - joint, 0.0, 1.0)
        waves = [np.sin(2.0 * np.pi * hertz * time + rng.uniform(0.0, 6.0)) for hertz in (0.3, 0.6, 1.0)]
        position[:, joint] += 0.4 * np.sin(np.pi * share) ** 2 * np.sum(waves, axis=0)
    velocity = np.gradient(position, time, axis=0)
    state = MotionState(position, velocity, np.gradient(velocity, time, axis=0), np.zeros(len(time)))
    model = standard_model(skew_arm())
    torque = model.torque(true_parameters(model, seed=3), state)
    return time, position, torque + 0.01 * torque.std(axis=0) * rng.normal(size=torque.shape)


def conflicts_of(time, position, torque):
    """List what is named, with its confidence."""
    log = log_from_arrays("log", time, position, torque)
    document = identify(IdentifyRequest(skew_arm(), (log,), PLAIN))
    return [(row["conflict"], row["joints"], row["confidence"]) for row in document["conflicts"]]


@pytest.mark.parametrize("seed", [1, 2])
def test_a_reversed_torque_is_sure_where_joints_move_one_after_the_other(seed):
    time, position, torque = one_after_the_other(seed)
    [(conflict, joints, confidence)] = conflicts_of(time, position, torque * np.array([1.0, -1.0, 1.0]))
    assert (conflict, joints) == ("torque_sign", [2])
    assert confidence > 0.9


@pytest.mark.parametrize("seed", [1, 2])
def test_no_exchange_of_torques_is_sure_there(seed):
    """Each torque is then judged in other rows than before, and the errors do not compare."""
    time, position, torque = one_after_the_other(seed)
    rows = conflicts_of(time, position, torque[:, [0, 2, 1]])
    assert rows
    assert all(confidence <= 0.5 for *_, confidence in rows)
