"""A result document is read as the robot it tells of: as identified, and as a diagnosis extended it."""

import json
from dataclasses import replace

import numpy as np
import pytest

from tests.app.planar_arm import columns, description
from tests.core.diagnosis.scenes import bodies_of_skew_arm, skew_arm
from tests.core.export import engines
from tests.core.export.robots import ROBOTS, brisk, identified
from veritorque.core.diagnosis.causes.encoder_offset import EncoderOffset as EncoderOffsetCause
from veritorque.core.document.model.identified import IdentifiedRobot
from veritorque.core.document.model.model_file import model_document, read_model
from veritorque.core.document.model.reading import identified_model, identified_robot
from veritorque.core.document.model.terms import named_terms
from veritorque.core.document.numbers import plain
from veritorque.core.dynamics.model import DynamicModel, standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.dynamics.terms.coulomb import Coulomb
from veritorque.core.dynamics.terms.encoder_error import EncoderOffset
from veritorque.core.dynamics.terms.friction_change import FrictionChange
from veritorque.core.dynamics.terms.friction_stribeck import Stribeck
from veritorque.core.dynamics.terms.joint_coupling import MissingCoupling
from veritorque.core.dynamics.terms.link_parameters import LinkChange
from veritorque.core.dynamics.terms.rotor_inertia_missing import MissingRotor
from veritorque.core.errors import RobotError
from veritorque.core.export.formats import FORMATS
from veritorque.core.export.mjcf import write_mjcf
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import Coupling
from veritorque.core.robot.writing import to_description
from veritorque.core.study import IdentifyRequest, identify

QUICK = {"bootstrap": {"draws": 0}}
MOTOR = Coupling("found", 3, (2, 3), (1.0, 1.0))
ERROR = 1e-4
"""Of the encoder, rad: a first-order column and a turned zero then differ by 1e-8 of the torque."""


def document_of(**options):
    log = log_from_arrays("arm", *columns(seconds=10.0))
    return identify(IdentifyRequest(robot_from_description(description()), (log,), QUICK | options))


@pytest.fixture(scope="module")
def document():
    return json.loads(json.dumps(document_of()))


def values_of(document):
    return {row["name"]: row["value"] for row in document["standard_parameters"]}


def test_an_identified_robot_has_the_documents_numbers_and_marks(document):
    found = identified_robot(document)
    assert found.values == values_of(document)
    rows = zip(document["standard_parameters"], found.identifiable, strict=True)
    assert all(row["identifiable"] == known for row, known in rows)
    assert [one.grouping for one in found.base] == [row["grouping"] for row in document["base_parameters"]]
    assert to_description(found.robot) == document["robot"]
    assert found.remarks == ()


def test_the_representative_has_the_base_parameters_that_the_motion_told(document):
    values = values_of(document)
    for row in document["base_parameters"]:
        summed = sum(share * values[name] for name, share in row["relation"].items())
        assert summed == pytest.approx(row["value"], abs=1e-8)


@pytest.mark.parametrize("terms", [["rigid_body"], ["rigid_body", "viscous", "coulomb"]])
def test_terms_that_were_left_out_are_not_in_the_files(terms):
    found = identified_robot(document_of(terms=terms))
    assert [term.name for term in found.model.terms] == terms


def test_smoothed_friction_keeps_its_widths():
    document = document_of(smooth_coulomb=True)
    (coulomb,) = (term for term in identified_robot(document).model.terms if isinstance(term, Coulomb))
    assert coulomb.widths == tuple(document["coulomb_smoothing_widths"])


def test_that_essential_parameters_alone_were_fitted_is_said():
    assert "essential" in identified_robot(document_of(essential=True)).remarks[0]


def test_a_result_that_does_not_name_its_terms_is_refused_rather_than_guessed(document):
    with pytest.raises(RobotError) as refusal:
        identified_robot({key: value for key, value in document.items() if key != "terms"})
    assert refusal.value.evidence["missing"] == "/terms"


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_is_written_from_a_result(document, name):
    assert FORMATS[name].write(document)
    assert FORMATS[name].write(document) == FORMATS[name].write(document)


@pytest.mark.parametrize("name", ROBOTS)
def test_engines_need_our_torque_for_a_robot_that_a_document_has_rounded(name):
    whole = identified(ROBOTS[name])
    rows = zip(whole.model.parameters, whole.standard, strict=True)
    listed = [{"name": one.name, "value": value, "identifiable": "no"} for one, value in rows]
    document = {
        "robot": to_description(whole.robot),
        "provenance": {"options": {}},
        "coulomb_smoothing_widths": [],
        "terms": named_terms(whole.model),
        "standard_parameters": listed,
        "base_parameters": [],
    }
    found = identified_robot(plain(document))
    state, text = brisk(found.robot), write_mjcf(found)
    names = [joint.name for joint in found.robot.joints]
    theirs = engines.mujoco_torque(engines.mujoco_model(text), names, state, engines.mimics_of_mjcf(text))
    ours = found.model.torque(found.standard, state) - found.of_joints("OFF")
    np.testing.assert_allclose(theirs, ours, rtol=0, atol=1e-9)


@pytest.fixture(scope="module")
def extension():
    """Give a diagnosed document whose extended model has a term of every fate, and that model."""
    robot = skew_arm()
    standard = standard_model(robot)
    rng = np.random.default_rng(7)
    numbers = rng.uniform(0.1, 0.5, len(standard.parameters))
    numbers[:30] = bodies_of_skew_arm().ravel()
    believed = Prediction(standard_model(robot, ("rigid_body",)), bodies_of_skew_arm().ravel())
    added = {
        MissingRotor(1): [0.3],
        MissingCoupling(MOTOR): [0.02, 0.1, 0.2],
        FrictionChange(2): [0.1, -0.05, 0.03],
        LinkChange(3, 3): list(0.1 * bodies_of_skew_arm()[2]),
        EncoderOffset(2, believed): [ERROR],
        Stribeck(3, 1.0): [0.7],
    }
    model = DynamicModel(robot, (*standard.terms, *added))
    whole = np.concatenate([numbers, *added.values()])
    extended = IdentifiedRobot(model, whole, ("in_combination",) * len(whole))
    mended = replace(EncoderOffsetCause().corrected_robot(robot, (2,), {"offset": ERROR}), couplings=(MOTOR,))
    diagnosis = {
        "after": {"model": model_document(extended)},
        "repaired_robot": to_description(mended),
        "repairs": [
            {"cause": "encoder_offset", "joints": [2], "mends": "robot", "what": "Joint 2's theta_offset"},
            {"cause": "friction_stribeck", "joints": [3], "mends": "model", "what": "A further term"},
        ],
    }
    document = {"robot": to_description(robot), "diagnosis": diagnosis}
    return json.loads(json.dumps(document)), extended, mended


def test_the_model_file_holds_the_whole_extended_model(extension):
    document, extended, _ = extension
    again = read_model(FORMATS["model.json"].write(document))
    state = brisk(extended.robot)
    np.testing.assert_allclose(
        again.model.torque(again.standard, state),
        extended.model.torque(extended.standard, state),
        rtol=0,
        atol=1e-12,
    )
    assert identified_model(document).model.parameters == extended.model.parameters


def test_other_files_hold_what_only_changed_parameters_and_the_repaired_robot(extension):
    document, extended, mended = extension
    found = identified_robot(document)
    before = dict(zip((one.name for one in extended.model.parameters), extended.standard, strict=True))
    values = found.values
    assert values["IA1"] == 0.3
    assert values["FV2"] == pytest.approx(before["FV2"] + 0.1, abs=1e-15)
    assert values["XX3"] == pytest.approx(1.1 * before["XX3"], abs=1e-15)
    assert [(motor.coupling, motor.coulomb) for motor in found.motors] == [(MOTOR, 0.2)]
    assert found.robot.links[1].row == mended.links[1].row
    assert found.robot.joints[0].rotor_inertia


def test_the_torque_of_the_other_files_is_the_extended_models_without_what_they_cannot_hold(extension):
    document, extended, _ = extension
    found = identified_robot(document)
    state = brisk(extended.robot)
    stribeck = extended.model.terms[-1]
    without = extended.model.torque(extended.standard, state)
    without[:, 2] -= 0.7 * stribeck.series(extended.robot, state)[0]
    theirs = found.model.torque(found.standard, state)
    # The extended model counts the operating point's bodies for the turn, and a tenth of the last link more.
    np.testing.assert_allclose(theirs, without, rtol=0, atol=ERROR)
    assert np.abs(theirs - extended.model.torque(extended.standard, state)).max() > 0.05


def test_what_the_other_files_leave_out_and_what_they_repaired_is_said(extension):
    document, _, _ = extension
    repaired, beyond = identified_robot(document).remarks
    assert "encoder_offset: Joint 2's theta_offset" in repaired
    assert "friction_stribeck_3" in beyond
    assert "model.json" in beyond
    assert "encoder_offset" not in beyond


def test_a_diagnosis_that_found_nothing_gives_the_robot_as_identified(document):
    nothing = {"after": {"validation": [], "base_parameters": []}, "repairs": [], "repaired_robot": None}
    found = identified_robot(document | {"diagnosis": nothing})
    assert found.values == values_of(document)
