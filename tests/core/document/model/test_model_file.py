"""The model's file loads back to an equal model, whatever terms a diagnosis put into it."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.core.diagnosis.scenes import eventful_scene
from tests.core.dynamics.every_term import FILES, cures, traces
from tests.core.export.robots import ROBOTS, brisk, identified
from tests.tools import random_bodies, random_robot
from veritorque.core.document.model.identified import IdentifiedRobot
from veritorque.core.document.model.model_file import read_model, write_model
from veritorque.core.document.model.terms import known_terms
from veritorque.core.dynamics.model import DynamicModel, standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.dynamics.term import Term
from veritorque.core.dynamics.terms.coulomb import Coulomb
from veritorque.core.dynamics.terms.friction_load_dependent import LoadFriction
from veritorque.core.dynamics.terms.payload_change import Payload
from veritorque.core.dynamics.terms.time_delay import Delay
from veritorque.core.dynamics.terms.torque_gain import TorqueGain
from veritorque.core.errors import RobotError
from veritorque.core.robot.model import RobotModel
from veritorque.core.robot.writing import to_description


def made_of(model: DynamicModel, seed: int = 0) -> IdentifiedRobot:
    values = np.random.default_rng(seed).normal(size=len(model.parameters))
    return IdentifiedRobot(model, values, ("in_combination",) * len(values), remarks=("By hand.",))


def extended(*terms: Term) -> IdentifiedRobot:
    scene = eventful_scene()
    model = standard_model(scene.dataset.robot)
    return made_of(DynamicModel(model.robot, (*model.terms, *terms)))


@pytest.mark.parametrize("name", ROBOTS)
def test_a_standard_model_comes_back_equal(name):
    found = identified(ROBOTS[name])
    again = read_model(write_model(found))
    assert to_description(again.robot) == to_description(found.robot)
    assert again.model.terms == found.model.terms
    assert again.model.parameters == found.model.parameters
    np.testing.assert_array_equal(again.standard, found.standard)
    assert (again.identifiable, again.base, again.remarks) == (found.identifiable, found.base, found.remarks)
    state = brisk(found.robot)
    np.testing.assert_array_equal(
        again.model.torque(again.standard, state), found.model.torque(found.standard, state)
    )


@pytest.mark.parametrize("term", [*cures(), *traces()], ids=lambda term: term.name)
def test_every_term_that_a_diagnosis_knows_comes_back_with_its_torque(term):
    found = extended(term)
    again = read_model(write_model(found))
    assert again.model.parameters == found.model.parameters
    assert [one.name for one in again.model.terms] == [one.name for one in found.model.terms]
    state = eventful_scene().dataset.stretches[0].state
    ours, theirs = (one.model.terms[-1].series(found.robot, state) for one in (found, again))
    # The torque is computed by the plain recursion after reading, by the compiled one before.
    np.testing.assert_allclose(theirs, ours, rtol=0, atol=1e-9 * max(1.0, float(np.abs(ours).max())))


def test_the_terms_that_the_file_knows_are_those_of_the_folder():
    modules = {kind.__module__.rsplit(".", 1)[-1] for kind in known_terms().values()}
    assert modules == set(FILES)


def test_a_prediction_that_several_terms_share_is_written_once_and_shared_again():
    scene = eventful_scene()
    found = extended(TorqueGain(1, scene.operating_point), TorqueGain(2, scene.operating_point))
    text = write_model(found)
    assert len(json.loads(text)["beliefs"]) == 1
    first, second = read_model(text).model.terms[-2:]
    assert first.believed is second.believed
    np.testing.assert_array_equal(first.believed.standard, scene.operating_point.standard)


def test_a_prediction_comes_back_with_what_joined_it_and_with_what_that_is_built_on():
    scene = eventful_scene()
    friction = (LoadFriction(1, scene.operating_point), np.array([0.2]))
    acted = replace(scene.operating_point, joined=(friction,))
    scaled = replace(acted, joined=(friction, (TorqueGain(1, acted), np.array([0.1]))))
    found = extended(Delay(0, scaled, 0.02))
    again = read_model(write_model(found))
    state = scene.dataset.stretches[0].state
    ours, theirs = (one.model.terms[-1].series(found.robot, state) for one in (found, again))
    plain = Delay(0, scene.operating_point, 0.02).series(found.robot, state)
    assert np.abs(ours - plain).max() > 1e-3
    np.testing.assert_allclose(theirs, ours, rtol=0, atol=1e-9 * max(1.0, float(np.abs(ours).max())))


def test_a_payload_that_was_there_from_the_beginning_has_been_there_for_ever():
    payload = read_model(write_model(extended(Payload(2, 2, -np.inf)))).model.terms[-1]
    assert payload.begin == -np.inf


@given(st.integers(0, 2**32 - 1), st.lists(st.floats(0.0, 1.0), min_size=2, max_size=2))
@settings(max_examples=25)
def test_every_digit_comes_back(seed, widths):
    rng = np.random.default_rng(seed)
    robot = replace(random_robot(rng, 2, tree=True), prior=random_bodies(rng, 2))
    found = made_of(standard_model(robot).with_term(Coulomb(tuple(widths))), seed)
    text = write_model(found)
    again = read_model(text)
    np.testing.assert_array_equal(again.standard, found.standard)
    assert again.model.terms == found.model.terms
    assert write_model(again) == text


def changed(**entries: object) -> str:
    return json.dumps(json.loads(write_model(identified(ROBOTS["yumi-left"]))) | entries)


def without(name: str) -> str:
    document = json.loads(write_model(identified(ROBOTS["yumi-left"])))
    del document[name]
    return json.dumps(document)


TERM = {"term": "Stribeck", "name": "s", "parameters": []}
BROKEN = {
    "no JSON": "{",
    "a number": "1",
    "another document": "{}",
    "another version": changed(format_version="0.9"),
    "no robot": changed(robot=None),
    "robot left out": without("robot"),
    "terms left out": without("terms"),
    "beliefs left out": without("beliefs"),
    "terms that are no list": changed(terms=3),
    "a term that is not known": changed(terms=[TERM | {"term": "Exec", "made_with": {}}]),
    "a term without its fields": changed(terms=[TERM | {"made_with": {"joint": 1}}]),
    "a belief that is not there": changed(
        terms=[TERM | {"term": "TorqueGain", "made_with": {"joint": 1, "believed": 4}}]
    ),
    "parameters of another term": changed(terms=[{"term": "Viscous", "made_with": {}, "parameters": []}]),
}


@pytest.mark.parametrize("text", BROKEN.values(), ids=BROKEN)
def test_a_file_that_cannot_be_used_is_refused_with_what_was_seen(text):
    with pytest.raises(RobotError) as caught:
        read_model(text)
    assert caught.value.evidence
    assert caught.value.remedy


def test_a_prediction_within_a_prediction_is_refused_rather_than_lost():
    scene = eventful_scene()
    inner = DynamicModel(scene.dataset.robot, (TorqueGain(1, scene.operating_point),))
    with pytest.raises(RobotError, match="another one"):
        write_model(extended(TorqueGain(1, Prediction(inner, np.ones(1)))))


def test_joints_against_the_order_of_their_links_are_refused():
    plain = random_robot(np.random.default_rng(0), 2)
    crossed = tuple(replace(link, joint=3 - link.joint) for link in plain.links)
    robot = RobotModel("crossed", crossed, plain.joints, plain.gravity)
    with pytest.raises(RobotError, match="numbered against"):
        write_model(identified(robot))
