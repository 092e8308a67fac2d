"""Hold the simulation to every torque term that there is, found by listing `core/dynamics/terms`.

A term is simulated in one of three ways: computed from the state of the moment, taken along the measured
motion where it remembers the past, or taken out of the torque where only the channel has it. Whichever it is,
a robot with it that is driven by the torque of a motion goes that motion.
"""

from functools import cache

import numpy as np
import pytest

from core.diagnosis.catalogue import AGAINST_REFERENCE
from core.dynamics.model import STANDARD_TERMS, DynamicModel, standard_model
from core.dynamics.term import Term
from core.dynamics.terms.trace import Trace
from core.log.reader import log_from_arrays
from core.signals.condition import Motion, condition
from core.signals.state import MotionState
from core.simulation.mechanism import Mechanism, mechanism_of
from core.simulation.multistep import MultiStepOptions, predict_motion
from core.simulation.stage import accelerations
from tests.core.diagnosis.scenes import eventful_scene, skew_arm
from tests.core.dynamics.every_term import FILES, SEARCHED, cures, file_of, searched
from tests.core.dynamics.terms.motions import swinging
from tests.core.estimate.worlds import true_parameters

WINDOWS = MultiStepOptions(horizons=(0.05, 0.1, 0.2), every=0.25)
SHARE = 0.3
"""A term's torque over that of the rest of the model, RMS."""


@cache
def motion_state() -> MotionState:
    return swinging(3, 12.0)


def whole_model(term: Term) -> DynamicModel:
    """Put a term on the standard model, in place of the standard one of its name."""
    return standard_model(skew_arm()).with_term(term)


def numbers(model: DynamicModel, term: Term) -> np.ndarray:
    """Give the model's parameters, the term's in such a size that it matters and in the sense nature allows."""
    plain = standard_model(skew_arm())
    truth = {one.name: value for one, value in zip(plain.parameters, true_parameters(plain), strict=True)}
    if term.name in STANDARD_TERMS:
        return np.array([truth[one.name] for one in model.parameters])
    unit = np.ones(len(term.parameters(model.robot)))
    series = DynamicModel(model.robot, (term,)).torque(unit, motion_state())
    whole = plain.torque(true_parameters(plain), motion_state())
    own = SHARE * np.sqrt(np.mean(whole**2) / np.mean(series**2))
    return np.array([truth.get(one.name, own) for one in model.parameters])


def logged(torque: np.ndarray) -> Motion:
    """Log the motion with a torque, without noise."""
    state = motion_state()
    log = log_from_arrays("made", state.time, state.position, torque, temperature=state.temperature)
    return condition(log, skew_arm(), blocks=6)


def strayed(mechanism: Mechanism, torque: np.ndarray) -> float:
    """Give how far the driven robot strays, over how far it would without any model."""
    found = predict_motion(mechanism, (logged(torque),), WINDOWS)
    return float(np.linalg.norm(found.position) / np.linalg.norm(found.still))


@pytest.mark.parametrize("name", SEARCHED)
def test_a_term_remembers_if_and_only_if_its_torque_at_an_instant_needs_the_others(name):
    robot, state = skew_arm(), motion_state()
    chosen = np.random.default_rng(1).permutation(len(state.position))[:500]
    assert state.time is not None
    assert state.temperature is not None
    alone = MotionState(
        *(one[chosen] for one in (state.position, state.velocity, state.acceleration)),
        state.time[chosen],
        state.temperature[chosen],
    )
    changed = []
    for term in searched(name):
        whole, part = term.series(robot, state), term.series(robot, alone)
        changed.append(np.abs(part - whole[:, chosen]).max() > 1e-6 * np.abs(whole).max())
        assert term.remembers or not changed[-1]
    assert any(changed) == searched(name)[0].remembers


def test_only_the_torque_channel_is_left_out_of_the_robot():
    causes = {cause.id: cause.cure for cause in AGAINST_REFERENCE}
    scene = eventful_scene()
    for cause in AGAINST_REFERENCE:
        site = cause.sites(scene.look, scene.believed)[-1:]
        for one in site:
            scalars = cause.grid(scene.look, scene.believed, one)[0]
            term = cause.term(scene.look, scene.believed, one, scalars)
            lying = causes[cause.id] == "signal" and not cause.id.startswith("encoder")
            assert term.channel == lying, cause.id


@pytest.mark.parametrize("name", FILES)
def test_a_robot_driven_by_the_torque_of_a_motion_goes_that_motion(name):
    terms = [STANDARD_TERMS[name]()] if name in STANDARD_TERMS else searched(name)
    for term in terms:
        model = whole_model(term)
        values = numbers(model, term)
        torque = model.torque(values, motion_state())
        with_it = strayed(mechanism_of(model, values), torque)
        print(
            name,
            term.name,
            with_it,
            strayed(
                mechanism_of(standard_model(skew_arm()), true_parameters(standard_model(skew_arm()))), torque
            ),
        )
