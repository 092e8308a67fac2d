"""Three slides show gravity by constant forces alone, so that a spring on the wrist is no other mounting."""

import numpy as np
import pytest

from tests.conflicts.score import PLAIN
from tests.core.estimate.worlds import true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.model import RobotModel
from veritorque.core.robot.urdf.read import robot_from_urdf
from veritorque.core.signals.state import MotionState
from veritorque.core.study import IdentifyRequest, identify

AXES = (("prismatic", "1 0 0"), ("prismatic", "0 1 0"), ("prismatic", "0 0 1"), ("revolute", "0 0 1"))
RATE_HZ = 100.0


def gantry(gravity: tuple[float, float, float] = (0.0, 0.0, -9.81)) -> RobotModel:
    """Describe three slides and a wrist about the vertical."""
    links = "".join(f'<link name="l{number}"/>' for number in range(len(AXES) + 1))
    joints = "".join(
        f'<joint name="j{number}" type="{kind}"><parent link="l{number}"/><child link="l{number + 1}"/>'
        f'<axis xyz="{axis}"/><limit lower="-3" upper="3" effort="500" velocity="3"/></joint>'
        for number, (kind, axis) in enumerate(AXES)
    )
    return robot_from_urdf(f'<robot name="gantry">{links}{joints}</robot>', gravity=gravity)


def jogged(rng: np.random.Generator, seconds: float = 40.0) -> MotionState:
    """Move one joint after the other, each time along a polynomial of fifth order."""
    time = np.arange(int(seconds * RATE_HZ)) / RATE_HZ
    position, velocity, acceleration = np.zeros((3, len(time), len(AXES)))
    begin, now = 0.2, np.zeros(len(AXES))
    while begin < seconds - 3.0:
        joint, goal = rng.integers(len(AXES)), rng.uniform(-1.0, 1.0)
        way = goal - now[joint]
        lasts = max(0.6, 1.5 * abs(way))
        part = np.clip((time - begin) / lasts, 0.0, 1.0)
        position[:, joint] += way * np.polyval([6.0, -15.0, 10.0, 0.0, 0.0, 0.0], part)
        velocity[:, joint] += way / lasts * np.polyval([30.0, -60.0, 30.0, 0.0, 0.0], part)
        acceleration[:, joint] += way / lasts**2 * np.polyval([120.0, -180.0, 60.0, 0.0], part)
        now[joint], begin = goal, begin + lasts + rng.uniform(0.1, 0.3)
    return MotionState(position, velocity, acceleration)


def named(seed: int, true: RobotModel, *, spring: bool) -> dict[str, bool]:
    """Name what is wrong with a log that is read as one of an upright gantry, and whether that is likely.

    Its torques have 1 % of noise.
    """
    rng = np.random.default_rng(seed)
    state, model = jogged(rng), standard_model(true)
    torque = model.torque(true_parameters(model, seed=seed), state)
    torque[:, 3] += spring * rng.uniform(0.5, 3.0) * (state.position[:, 3] - 0.3)
    torque += 0.01 * np.std(torque, axis=0) * rng.normal(size=torque.shape)
    log = log_from_arrays("jogged", np.arange(len(torque)) / RATE_HZ, state.position, torque)
    document = identify(IdentifyRequest(gantry(), (log,), PLAIN))
    return {row["conflict"]: row["confidence"] > 0.5 for row in document["conflicts"]}


@pytest.mark.parametrize("seed", [0, 1, 6, 7])
def test_a_spring_on_a_gantrys_wrist_is_no_other_mounting(seed):
    assert not any(named(seed, gantry(), spring=True).values())


@pytest.mark.parametrize("seed", [0, 1])
def test_a_direction_that_the_slides_contradict_is_not_sure_though_gravity_is_another(seed):
    """The wrist tells only that gravity is not along its axis: to it, all such directions are alike."""
    assert named(seed, gantry(gravity=(0.0, -9.81, 0.0)), spring=False) == {"mounting": False}
