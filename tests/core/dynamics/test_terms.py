"""Hold every torque term to the same contract, found by listing the files of `core/dynamics/terms`.

A term is one of the standard model, asked for by name, the cure of a cause of the diagnosis, or a pattern
that no cause has.
"""

import ast

import numpy as np
import pytest

from tests.core.diagnosis.scenes import eventful_scene
from tests.core.dynamics.every_term import (
    FILES,
    FOLDER,
    IN_MOTION,
    SEARCHED,
    cures,
    file_of,
    searched,
    traces,
)
from tests.tools import random_robot
from veritorque.core.dynamics.model import STANDARD_TERMS, DynamicModel, standard_model
from veritorque.core.dynamics.term import Term
from veritorque.core.dynamics.terms.coulomb import Coulomb, direction
from veritorque.core.dynamics.terms.unnamed_pattern import PATTERNS
from veritorque.core.errors import OptionError
from veritorque.core.regressor.columns import all_columns
from veritorque.core.robot.model import Coupling, RobotModel
from veritorque.core.signals.state import MotionState

TERMS = sorted(STANDARD_TERMS)


@pytest.fixture
def robot() -> RobotModel:
    plain = random_robot(np.random.default_rng(5), 4)
    coupling = Coupling("wrist", 4, (3, 4), (1.0, 1.0))
    return RobotModel(plain.name, plain.links, plain.joints, plain.gravity, (coupling,))


@pytest.fixture
def state() -> MotionState:
    rng = np.random.default_rng(6)
    return MotionState(*(rng.normal(size=(40, 4)) for _ in range(3)))


def test_every_file_of_terms_is_a_standard_term_or_the_term_of_a_cause_or_the_patterns_without_one():
    found = {file_of(term) for term in (*cures(), *traces())}
    assert set(FILES) == set(STANDARD_TERMS) | found | IN_MOTION
    assert all(term().name == name for name, term in STANDARD_TERMS.items())


def test_a_search_tries_every_pattern_that_has_no_cause():
    assert {term.pattern for term in traces()} == set(PATTERNS)


@pytest.mark.parametrize("name", SEARCHED)
def test_a_searched_term_keeps_the_contract_of_all_terms(name):
    scene = eventful_scene()
    robot, state = scene.dataset.robot, scene.dataset.stretches[0].state
    terms = searched(name)
    assert terms
    for term in terms:
        assert isinstance(term, Term)
        entries, parameters = term.entries(robot), term.parameters(robot)
        series = term.series(robot, state)
        assert series.shape == (len(entries), len(state.position))
        assert np.isfinite(series).all()
        assert len(set(entries)) == len(entries)
        assert {parameter for _, parameter in entries} == set(range(len(parameters)))
        assert all(0 <= joint < len(robot.joints) for joint, _ in entries)
        assert len({parameter.name for parameter in parameters}) == len(parameters)
        assert all(parameter.unit for parameter in parameters)


@pytest.mark.parametrize("name", FILES)
def test_a_term_says_where_it_comes_from(name):
    text = ast.get_docstring(ast.parse((FOLDER / f"{name}.py").read_text())) or ""
    assert "Source" in text


@pytest.mark.parametrize("name", TERMS)
def test_a_term_gives_one_series_for_every_entry_it_announces(name, robot, state):
    term = STANDARD_TERMS[name]()
    entries, parameters = term.entries(robot), term.parameters(robot)
    assert term.series(robot, state).shape == (len(entries), 40)
    assert len(set(entries)) == len(entries)
    assert {parameter for _, parameter in entries} == set(range(len(parameters)))
    assert all(0 <= joint < 4 for joint, _ in entries)


@pytest.mark.parametrize("name", TERMS)
def test_parameters_of_a_term_have_unique_names_and_a_unit(name, robot):
    parameters = STANDARD_TERMS[name]().parameters(robot)
    assert len({parameter.name for parameter in parameters}) == len(parameters)
    assert all(parameter.unit for parameter in parameters)


@pytest.mark.parametrize("name", TERMS)
def test_the_compiled_columns_give_the_torque_the_term_gives_by_itself(name, robot, state):
    model = DynamicModel(robot, (STANDARD_TERMS[name](),))
    values = np.random.default_rng(7).normal(size=len(model.parameters))
    plan = all_columns(model)
    torque = np.zeros((40, 4))
    for (joint, column), row in zip(plan.entries, plan.series(state), strict=True):
        torque[:, joint] += values[column] * row
    np.testing.assert_allclose(torque, model.torque(values, state), rtol=0, atol=1e-11 * np.abs(torque).max())


@pytest.mark.parametrize("name", ["viscous", "coulomb"])
def test_friction_never_drives_the_joint(name, robot, state):
    model = DynamicModel(robot, (STANDARD_TERMS[name](),))
    torque = model.torque(np.ones(len(model.parameters)), state)
    assert (torque * state.velocity >= 0.0).all()


def test_the_motor_of_a_coupling_takes_exactly_the_power_its_joints_give(robot, state):
    model = standard_model(robot, ("coupling",))
    torque = model.torque(np.array([0.3, 0.7, 0.2]), state)
    speed = state.velocity[:, 2] + state.velocity[:, 3]
    rate = state.acceleration[:, 2] + state.acceleration[:, 3]
    motor = 0.3 * rate + 0.7 * speed + 0.2 * np.sign(speed)
    np.testing.assert_allclose((torque * state.velocity).sum(axis=1), motor * speed, rtol=1e-12, atol=1e-12)


def test_a_smoothed_sign_becomes_the_plain_one_far_from_standstill():
    velocity = np.array([-1.0, -0.2, 0.2, 1.0])
    np.testing.assert_allclose(direction(velocity, 0.01), np.sign(velocity), atol=1e-12)
    assert direction(np.array([0.0]), 0.01)[0] == 0.0


def test_extending_a_model_replaces_the_term_of_the_same_name(robot):
    model = standard_model(robot)
    smooth = model.with_term(Coulomb((0.1,) * 4))
    assert [term.name for term in smooth.terms].count("coulomb") == 1
    assert {one.name for one in smooth.parameters} == {one.name for one in model.parameters}


def test_an_unknown_term_is_refused_with_the_list_of_known_ones(robot):
    with pytest.raises(OptionError) as refusal:
        standard_model(robot, ("rigid_body", "stribek"))
    assert refusal.value.evidence["unknown"] == ["stribek"]
    assert set(refusal.value.evidence["known"]) == set(STANDARD_TERMS)
