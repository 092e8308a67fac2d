"""Hold the friction effects to the laws of friction: it brakes, knows the direction, has known limits."""

import numpy as np
import pytest

from tests.core.dynamics.terms.motions import cycle, swinging
from tests.tools import random_robot
from veritorque.core.dynamics.terms.coulomb import Coulomb
from veritorque.core.dynamics.terms.effect import OneJointTerm
from veritorque.core.dynamics.terms.friction_asymmetric import AsymmetricViscous
from veritorque.core.dynamics.terms.friction_position_dependent import PositionFriction
from veritorque.core.dynamics.terms.friction_presliding import Presliding, dahl
from veritorque.core.dynamics.terms.friction_temperature import TemperatureFriction, WarmUpFriction
from veritorque.core.dynamics.terms.friction_viscous_nonlinear import NonlinearViscous
from veritorque.core.dynamics.terms.viscous import Viscous
from veritorque.core.signals.state import MotionState

ROBOT = random_robot(np.random.default_rng(0), 2, prismatic=0.0)
STATE = swinging()


def backwards(state: MotionState) -> MotionState:
    return MotionState(state.position, -state.velocity, state.acceleration, state.time, state.temperature)


@pytest.mark.parametrize(
    "term",
    [
        NonlinearViscous(1, 0.5),
        PositionFriction(1, 3.0, 0.2),
        TemperatureFriction(1, 25.0),
        WarmUpFriction(1, 0.0, 4.0),
    ],
    ids=lambda term: type(term).__name__,
)
def test_friction_turns_round_with_the_direction_of_motion(term: OneJointTerm) -> None:
    np.testing.assert_array_equal(term.series(ROBOT, backwards(STATE)), -term.series(ROBOT, STATE))


def test_asymmetric_friction_is_the_same_torque_in_both_directions() -> None:
    term = AsymmetricViscous(1)
    np.testing.assert_array_equal(term.series(ROBOT, backwards(STATE)), term.series(ROBOT, STATE))


def test_viscous_friction_with_a_difference_is_more_forwards_and_less_backwards() -> None:
    forwards = STATE.velocity[:, 0] > 0.0
    total = 2.0 * Viscous().series(ROBOT, STATE)[0] + 0.5 * AsymmetricViscous(1).series(ROBOT, STATE)[0]
    np.testing.assert_allclose(total, np.where(forwards, 2.5, 1.5) * STATE.velocity[:, 0], rtol=1e-12)


def test_a_power_of_one_is_viscous_friction_and_a_power_of_zero_is_coulomb_friction() -> None:
    one, zero = (NonlinearViscous(1, power).series(ROBOT, STATE)[0] for power in (1.0, 0.0))
    np.testing.assert_allclose(one, Viscous().series(ROBOT, STATE)[0], rtol=1e-12)
    np.testing.assert_allclose(zero, Coulomb().series(ROBOT, STATE)[0], rtol=1e-12)


def test_warm_up_begins_from_nothing_and_has_done_two_thirds_after_its_time_constant() -> None:
    coulomb, viscous = WarmUpFriction(1, 0.0, 4.0).series(ROBOT, STATE)
    share = coulomb / np.sign(STATE.velocity[:, 0])
    assert share[0] == 0.0
    assert share[1000] == pytest.approx(1.0 - np.exp(-1.0), rel=1e-12)
    np.testing.assert_allclose(viscous, share * STATE.velocity[:, 0], rtol=1e-9, atol=1e-15)


def test_friction_over_temperature_is_known_at_its_reference_and_grows_per_kelvin() -> None:
    coulomb, _ = TemperatureFriction(2, 30.0).series(ROBOT, STATE)
    share = coulomb / np.sign(STATE.velocity[:, 1])
    assert share[0] == 0.0
    assert share[-1] == pytest.approx(10.0)


def test_without_a_logged_temperature_nothing_follows_it() -> None:
    plain = MotionState(STATE.position, STATE.velocity, STATE.acceleration, STATE.time)
    assert not TemperatureFriction(1, 30.0).series(ROBOT, plain).any()


def integrated(position: np.ndarray, velocity: np.ndarray, distance: float, begin: float) -> np.ndarray:
    """Integrate df = (sign(v) - f) |dx| / distance by the implicit midpoint rule, step by step."""
    out = np.empty_like(position)
    out[0] = begin
    for index in range(1, len(out)):
        half = 0.5 * abs(position[index] - position[index - 1]) / distance
        out[index] = (out[index - 1] * (1.0 - half) + 2.0 * half * np.sign(velocity[index])) / (1.0 + half)
    return out


@pytest.mark.parametrize("distance", [0.02, 0.3, 3.0])
def test_presliding_friction_solves_dahls_equation_also_when_it_turns_before_it_has_built_up(
    distance: float,
) -> None:
    state = swinging(1, 10.0, 20000.0)
    position, velocity = state.position[:, 0], state.velocity[:, 0]
    expected = integrated(position, velocity, distance, np.sign(velocity[0]))
    # The turn itself falls between two samples, which shifts the path by less than one sample's, 1e-5 rad.
    np.testing.assert_allclose(dahl(position, velocity, distance), expected, atol=1e-6 / distance)


def test_presliding_friction_is_built_up_ten_distances_after_a_reversal() -> None:
    position = np.concatenate([np.linspace(0.0, 1.0, 101), np.linspace(1.0, 0.0, 101)[1:]])
    velocity = np.concatenate([np.ones(101), -np.ones(100)])
    state = MotionState(position[:, None], velocity[:, None], 0.0 * velocity[:, None])
    (column,) = Presliding(1, 0.02).series(ROBOT, state)
    assert not column[:101].any()
    assert column[101] == 2.0
    assert np.abs(column[122:]).max() < 2.0 * np.exp(-10.0)


def test_over_a_vanishing_distance_presliding_friction_is_coulomb_friction() -> None:
    turns = np.abs(np.diff(np.sign(STATE.velocity[:, 0]), prepend=np.sign(STATE.velocity[0, 0]))) > 0.0
    (column,) = Presliding(1, 1e-9).series(ROBOT, STATE)
    assert turns.any()
    assert np.abs(column[~turns]).max() < 1e-12


def test_presliding_friction_begins_from_nothing_where_the_joint_stands() -> None:
    rising = np.linspace(0.0, 1.0, 1001)
    assert dahl(rising**2, rising, 0.5)[0] == 0.0
    assert dahl(rising, np.ones(1001), 0.5)[0] == 1.0


@pytest.mark.parametrize(
    "term",
    [
        NonlinearViscous(1, 0.5),
        NonlinearViscous(1, 2.0),
        PositionFriction(1, 0.0, 0.0),
        WarmUpFriction(1, 0.0, 4.0),
    ],
    ids=lambda term: type(term).__name__,
)
def test_friction_takes_energy_over_a_closed_path(term: OneJointTerm) -> None:
    state = cycle()
    torque = term.series(random_robot(np.random.default_rng(0), 1), state)[0]
    assert np.trapezoid(torque * state.velocity[:, 0], state.time) > 0.1


def test_coulomb_friction_that_builds_up_takes_less_energy_but_never_gives_any() -> None:
    state = cycle()
    power = dahl(state.position[:, 0], state.velocity[:, 0], 0.2) * state.velocity[:, 0]
    taken, most = (np.trapezoid(one, state.time) for one in (power, np.abs(state.velocity[:, 0])))
    assert 0.0 < taken < 0.95 * most
