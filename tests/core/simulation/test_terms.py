"""Terms without a compiled form take part in the simulation, their jumps at standstill as friction."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

from core.dynamics.model import DynamicModel
from core.robot.parameters import Parameter
from core.signals.state import MotionState
from core.simulation.mechanism import mechanism_of
from core.simulation.stage import accelerations
from tests.core.simulation.worlds import block, play


@dataclass(frozen=True)
class Law:
    """Let any function of the first joint's position, velocity and acceleration act on it."""

    law: object
    name: str = "law"
    remembers: ClassVar[bool] = False
    channel: ClassVar[bool] = False

    def parameters(self, robot):
        return (Parameter("LAW", 1, 1, "N", None),)

    def entries(self, robot):
        return ((0, 0),)

    def series(self, robot, state):
        return self.law(state)[None, :]


def _with(law, **drives):
    plain = block(**drives)
    model = DynamicModel(plain.robot, (*plain.model.terms, Law(law)))
    return mechanism_of(model, np.append(plain.parameters, 1.0))


def _stribeck(state):
    speed = state.velocity[:, 0]
    return np.sign(speed) * np.exp(-((speed / 0.05) ** 2))


def _spring(state):
    return 200.0 * state.position[:, 0]


def test_a_term_that_jumps_at_standstill_holds_the_joint_together_with_coulomb_friction():
    body, still = _with(_stribeck, FC=1.0), np.zeros((4, 1))
    torque = np.array([[1.5], [1.999], [2.5], [-2.5]])
    found = accelerations(body, MotionState(still, still, still), torque)
    np.testing.assert_allclose(found[:, 0], [0.0, 0.0, 0.25, -0.25], atol=1e-9)


def test_a_jump_that_lowers_friction_at_standstill_lowers_what_holds_the_joint():
    body, still = _with(lambda state: -0.4 * np.sign(state.velocity[:, 0]), FC=1.0), np.zeros((2, 1))
    found = accelerations(body, MotionState(still, still, still), np.array([[0.59], [0.61]]))
    np.testing.assert_allclose(found[:, 0], [0.0, 0.005], atol=1e-9)


def test_a_body_on_a_spring_swings_at_its_frequency_to_order_two():
    def error(steps):
        moved = play(_with(_spring), 0.1, 0.0, 0.5, steps)
        return abs(moved.position[-1, 0, 0] - 0.1 * np.cos(10.0 * 0.5))

    assert 3.7 < error(100) / error(200) < 4.3


def test_stribeck_friction_slows_a_body_as_its_curve_says():
    moved = play(_with(_stribeck), 0.0, 0.3, 0.4, 4000, lambda time: np.array([1.0]))
    speed = moved.velocity[:, 0, 0]
    slope = np.gradient(speed, 1e-4)
    np.testing.assert_allclose(slope[2:-2], 0.5 * (1.0 - np.exp(-((speed[2:-2] / 0.05) ** 2))), atol=1e-5)


@pytest.mark.parametrize("share", [0.1, 0.5])
def test_a_term_of_the_acceleration_acts_in_the_long_run_as_the_inertia_it_is(share):
    body = _with(lambda state: 2.0 * share * state.acceleration[:, 0])
    moved = play(body, 0.0, 0.0, 1.0, 1000, lambda time: np.array([1.0]))
    np.testing.assert_allclose(moved.velocity[-1, 0, 0], 1.0 / (2.0 * (1.0 + share)), rtol=2e-3)


def test_terms_see_the_time_of_the_moment():
    body = _with(lambda state: -np.where(state.time < 0.5, 0.0, 1.0))
    moved = play(body, 0.0, 0.0, 1.0, 1000)
    np.testing.assert_allclose(moved.velocity[-1, 0, 0], 0.25, rtol=3e-3)
