"""Terms without a compiled form take part in the simulation, their jumps at standstill as friction."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

from tests.core.simulation.worlds import block, mechanism, play
from tests.tools import random_bodies, random_robot
from veritorque.core.dynamics.model import DynamicModel, standard_model
from veritorque.core.dynamics.terms.friction_asymmetric import AsymmetricViscous
from veritorque.core.dynamics.terms.joint_coupling import MissingCoupling
from veritorque.core.dynamics.terms.payload_change import Payload
from veritorque.core.dynamics.terms.rotor_inertia_missing import MissingRotor
from veritorque.core.robot.model import Coupling, Parameter
from veritorque.core.signals.state import MotionState
from veritorque.core.simulation.mechanism import mechanism_of
from veritorque.core.simulation.stage import accelerations

PLAIN = 28
"""Parameters of two links with their drives."""


@dataclass(frozen=True)
class Law:
    """Let any function of the first joint's position, velocity and acceleration act on it."""

    law: object
    name: str = "law"
    has_memory: ClassVar[bool] = False
    channel: ClassVar[bool] = False
    loads: ClassVar[bool] = False
    shapes_motion: ClassVar[bool] = False

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


@pytest.mark.parametrize("at_rest", [0, 1, 2, 3], ids="at rest: {}".format)
def test_states_side_by_side_are_what_each_of_them_is_alone(at_rest):
    body, still = _with(_stribeck, FC=1.0), np.zeros((3, 1))
    velocity = np.array([[0.01], [-0.04], [0.2]])
    velocity[:at_rest] = 0.0
    torque = np.array([[2.3], [-1.2], [1.5]])

    def found(some):
        state = MotionState(still[some], velocity[some], still[some])
        return accelerations(body, state, torque[some])

    np.testing.assert_array_equal(
        found(slice(None)), np.vstack([found(slice(one, one + 1)) for one in range(3)])
    )


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


def _and(term, *values):
    plain = block()
    model = DynamicModel(plain.robot, (*plain.model.terms, term))
    return mechanism_of(model, np.append(plain.parameters, values))


def test_a_rotor_that_the_description_lacks_may_be_heavier_than_all_it_moves():
    moved = play(_and(MissingRotor(1), 20.0), 0.0, 0.0, 1.0, 1000, lambda time: np.array([22.0]))
    np.testing.assert_allclose(moved.velocity[-1, 0, 0], 1.0, rtol=1e-9)


def test_damping_that_only_one_direction_has_may_be_as_stiff_as_it_likes():
    # 1e5 N s/m on 2 kg settles within 20 us, a fiftieth of a step, at force over damping
    moved = play(_and(AsymmetricViscous(1), 1e5), 0.0, 1e-4, 0.1, 100, lambda time: np.array([20.0]))
    np.testing.assert_allclose(moved.velocity[-1, 0, 0], 2e-4, rtol=1e-6)


def test_what_keeps_stiff_damping_stable_does_not_change_the_order():
    def error(steps):
        moved = play(_and(AsymmetricViscous(1), 20.0), 0.0, 1.0, 0.3, steps)
        return abs(moved.velocity[-1, 0, 0] - np.exp(-10.0 * 0.3))

    assert 3.5 < error(50) / error(100) < 4.5


def test_a_body_that_is_taken_up_may_be_heavier_than_what_takes_it():
    body = _and(Payload(1, 1, 0.5), *np.zeros(9), 20.0)
    moved = play(body, 0.0, 0.0, 1.0, 1000, lambda time: np.array([22.0]))
    np.testing.assert_allclose(moved.velocity[-1, 0, 0], 0.5 * 22.0 / 2.0 + 0.5 * 22.0 / 22.0, rtol=2e-3)


def test_states_of_different_times_carry_what_is_there_at_their_time():
    body, still = _and(Payload(1, 1, 0.5), *np.zeros(9), 20.0), np.zeros((3, 1))
    state = MotionState(still, still, still, np.array([0.4, 0.6, 0.499]))
    found = accelerations(body, state, np.full((3, 1), 22.0))
    np.testing.assert_allclose(found[:, 0], [11.0, 1.0, 11.0], rtol=1e-12)


def test_a_coupling_that_the_description_lacks_moves_and_holds_as_if_it_were_declared():
    rng = np.random.default_rng(34)
    plain, bodies = random_robot(rng, 2, gravity=False, prismatic=0.0), random_bodies(rng, 2)
    wrist = Coupling("wrist", 2, (1, 2), (1.0, 1.0))
    declared, missing = (
        mechanism_of(model, np.append(mechanism(model.robot, bodies).parameters[:PLAIN], [5.0, 0.3, 2.0]))
        for model in (
            standard_model(replace(plain, couplings=(wrist,))),
            standard_model(plain).with_term(MissingCoupling(wrist)),
        )
    )
    velocity = np.array([[0.0, 0.0], [0.4, -0.4], [0.3, 0.1]])
    state = MotionState(rng.normal(size=(3, 2)), velocity, np.zeros((3, 2)))
    torque = rng.normal(size=(3, 2))
    found, wanted = accelerations(missing, state, torque), accelerations(declared, state, torque)
    np.testing.assert_allclose(found, wanted, rtol=1e-12)
    assert abs(found[0].sum()) < 1e-10
