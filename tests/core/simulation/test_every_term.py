"""Hold the simulation to every torque term that there is, found by listing `core/dynamics/terms`.

A term is simulated in one of three ways: computed from the state of the moment, taken along the measured
motion where it remembers the past, or taken out of the torque where only the channel has it. Whichever it is,
a robot with it that is driven by the torque of a motion goes that motion.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tests.core.diagnosis.scenes import skew_arm
from tests.core.dynamics.every_term import FILES, SEARCHED, cures_by_cause, searched
from tests.core.dynamics.terms.motions import swinging
from tests.core.estimate.worlds import true_parameters
from tests.tools import random_robot
from veritorque.core.dynamics.model import STANDARD_TERMS, DynamicModel, standard_model
from veritorque.core.dynamics.term import Term
from veritorque.core.dynamics.terms.joint_elasticity import Elasticity
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.model import RobotModel
from veritorque.core.signals.condition import Motion, condition
from veritorque.core.signals.state import MotionState
from veritorque.core.simulation.mechanism import Mechanism, mechanism_of
from veritorque.core.simulation.multistep import MultiStepOptions, predict_motion
from veritorque.core.simulation.stage import accelerations

WINDOWS = MultiStepOptions(horizons=(0.05, 0.1, 0.2), every=0.5)
LATER = frozenset((0, block) for block in range(1, 6))
"""Of the time before a log nothing is known."""
SHARE = 0.3
"""A term's largest torque over the RMS of the rest of the model's, on the joint where that is most."""
LARGEST = {"rad": 0.03, "m": 0.01, "s": 0.005}
"""Beyond these an error is no small one, for which alone its term holds."""
LEFT = {False: 0.1, True: 0.25}
"""Share of a term's effect on the motion that may be left: what one remembers may lie before the stretch."""

RINGING = 2.0
"""Seconds in which a compliant joint's own swing falls to a third: what rings for longer began before the
stretch that a window is simulated in, see docs/limits.md."""


@cache
def motion_state() -> MotionState:
    return swinging(3, 12.0)


def some_of(state: MotionState, count: int) -> MotionState:
    """Choose instants at random, in their order."""
    chosen = np.sort(np.random.default_rng(1).permutation(len(state.position))[:count])
    series = (state.position, state.velocity, state.acceleration, state.time, state.temperature)
    return MotionState(*(one[chosen] for one in series if one is not None))


@cache
def tree() -> RobotModel:
    """Let two branches leave the first link."""
    robot = random_robot(np.random.default_rng(3), 3, prismatic=0.0)
    links = (*robot.links[:2], replace(robot.links[2], antecedent=1))
    return replace(robot, links=links)


def sized(model: DynamicModel, term: Term) -> np.ndarray:
    """Give parameters that exist, the term's in such a size that it matters."""
    plain = standard_model(model.robot)
    standard = true_parameters(plain)
    truth = {one.name: value for one, value in zip(plain.parameters, standard, strict=True)}
    own, whole = term.parameters(model.robot), plain.torque(standard, motion_state())
    series = DynamicModel(model.robot, (term,)).torque(np.ones(len(own)), motion_state())
    sizes = np.sqrt(np.mean(whole**2, axis=0)) / np.maximum(np.abs(series).max(axis=0), 1e-6)
    size = min(SHARE * sizes.min(), *(LARGEST.get(one.unit, np.inf) for one in own), np.inf)
    return np.array([truth.get(one.name, size) for one in model.parameters])


def logged(torque: np.ndarray) -> Motion:
    """Log the motion with a torque, without noise."""
    state = motion_state()
    log = log_from_arrays("made", state.time, state.position, torque, temperature=state.temperature)
    return condition(log, skew_arm(), blocks=6)


def strayed(mechanism: Mechanism, motion: Motion) -> float:
    """Give the simulated position error of the driven robot, over that without any model."""
    found = predict_motion(mechanism, (motion,), WINDOWS, chosen=LATER)
    return float(np.linalg.norm(found.position) / np.linalg.norm(found.still))


@cache
def plain() -> tuple[Mechanism, float]:
    """Give the arm of the standard model, and its simulated position error under its own torque."""
    model = standard_model(skew_arm())
    alone = mechanism_of(model, true_parameters(model))
    return alone, strayed(alone, logged(model.torque(alone.parameters, motion_state())))


def model_with(robot: RobotModel, term: Term) -> tuple[DynamicModel, np.ndarray]:
    model = standard_model(robot).with_term(term)
    return model, sized(model, term)


@pytest.mark.parametrize("name", SEARCHED)
def test_what_does_not_remember_needs_the_instant_alone_and_what_does_needs_more(name):
    robot, state = skew_arm(), motion_state()
    few = some_of(state, 500)
    same = []
    for term in searched(name):
        rows = np.searchsorted(state.time, few.time)
        whole, alone = term.series(robot, state)[:, rows], term.series(robot, few)
        same.append(np.allclose(alone, whole, atol=1e-9 * np.abs(whole).max()))
        assert term.has_memory or same[-1]
    assert all(same) != searched(name)[0].has_memory


@pytest.mark.parametrize(("cause", "term"), cures_by_cause(), ids=lambda one: getattr(one, "id", ""))
def test_only_corrections_of_the_torque_signal_are_left_out_of_the_robot(cause, term):
    assert term.channel == (cause.cure == "signal" and not cause.id.startswith("encoder"))


@pytest.mark.parametrize("robot", [skew_arm(), tree()], ids=["chain", "tree"])
@pytest.mark.parametrize("name", FILES)
def test_the_torque_of_an_acceleration_gives_that_acceleration(name, robot):
    state = motion_state()
    for term in [STANDARD_TERMS[name]()] if name in STANDARD_TERMS else searched(name, robot):
        model, values = model_with(robot, term)
        moved = mechanism_of(model, values)
        driving = model.torque(values, state) - moved.with_memory.torque(state) - moved.channel.torque(state)
        found = accelerations(moved, state, driving)
        np.testing.assert_allclose(found, state.acceleration, atol=1e-6)


@pytest.mark.parametrize("name", sorted(STANDARD_TERMS))
def test_a_robot_driven_by_the_torque_of_a_motion_goes_that_motion(name):
    model, values = model_with(skew_arm(), STANDARD_TERMS[name]())
    assert strayed(mechanism_of(model, values), logged(model.torque(values, motion_state()))) < 0.01


def _is_settled_in_a_stretch(term: Term) -> bool:
    if not isinstance(term, Elasticity):
        return True
    return 1.0 / (2.0 * np.pi * term.resonance_hz * term.damping_ratio) < RINGING


@pytest.mark.parametrize("name", SEARCHED)
def test_a_robot_with_any_further_term_goes_the_motion_of_its_torque_and_one_without_does_not(name):
    without, least = plain()
    shown = []
    for term in filter(_is_settled_in_a_stretch, searched(name)):
        model, values = model_with(skew_arm(), term)
        motion = logged(model.torque(values, motion_state()))
        missed, left = strayed(without, motion), strayed(mechanism_of(model, values), motion)
        shown.append(missed > 2.0 * least)
        # a reversal falls between two samples: up to thrice what friction alone leaves
        assert left < 3.0 * least + LEFT[term.has_memory] * missed
    assert any(shown)
