"""Read a result document as the robot that was identified: the whole model, or what every format can hold."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ...dynamics.model import STANDARD_TERMS, DynamicModel, standard_model
from ...dynamics.terms.coulomb import Coulomb
from ...dynamics.terms.flexible_joints import FlexibleJoints
from ...dynamics.terms.joint_coupling import MissingCoupling
from ...dynamics.terms.rotor_inertia_missing import MissingRotor
from ...errors import RobotError
from ...estimate.smoothing import with_widths
from ...extension.fold import fold, parts_of
from ...reduction.base import flexible_joints
from ...robot.description import robot_from_description
from ...robot.frames import nearest_rotation
from ...robot.model import Coupling, Parameter, RobotModel
from .answer import EXTENDED, answer_remarks, model_name, plain_document
from .identified import BaseValue, IdentifiedRobot
from .model_file import model_from_document
from .terms import named_terms

Document = Mapping[str, Any]
FLEXIBLE = "flexible_joints"
"""The term of springs between motors and links, which holds the joints that have one."""
_STANDARD_NAME: Mapping[type, str] = {MissingRotor: "rotor_inertia", MissingCoupling: "coupling"}
"""What a term that a diagnosis adds is called once the robot declares it."""
ESSENTIAL = (
    "The identification let essential base parameters alone explain torque: where the representative gives "
    "another base parameter a value, that value is the prior's."
)


def identified_model(document: Document) -> IdentifiedRobot:
    """Give the whole model of a result: after a diagnosis the extended one, with all its terms.

    Raises
    ------
    RobotError
        If the document's robot or model cannot be used.
    """
    extended = _extended_model(document)
    if extended is None:
        return _uncorrected_model(document)
    return replace(extended, remarks=(*extended.remarks, *_kept_apart(extended.model)))


def identified_robot(document: Document) -> IdentifiedRobot:
    """Give what every format can hold: bodies, rotors, friction, offsets and couplings.

    After a diagnosis these are the extended model's, on the robot with its repairs; what only the extended
    model has is named in the remarks.

    Raises
    ------
    RobotError
        If the document's robot or model cannot be used.
    """
    extended = _extended_model(document)
    if extended is None:
        return _uncorrected_model(document)
    extended = replace(extended, base=_answer_base(document, extended))
    diagnosis = document["diagnosis"]
    repaired = diagnosis.get("repaired_robot") or document["robot"]
    corrected = [repair for repair in diagnosis.get("repairs", ()) if repair["mends"] == "robot"]
    remarks = [f"The description was repaired, {repair['cause']}: {repair['what']}." for repair in corrected]
    return _standard_part(extended, _robot(repaired), {repair["cause"] for repair in corrected}, remarks)


def model_of_result(document: Document, robot: RobotModel) -> DynamicModel:
    """Build the plain model of a result, before any correction: the terms that it names.

    Raises
    ------
    RobotError
        If the result does not name them.
    """
    names = plain_document(document).get("terms")
    if not names:
        raise RobotError(
            "the result does not name the torque terms of its model",
            evidence={"missing": "/terms", "version": document["provenance"].get("version")},
            remedy="it is of an earlier build: delete its job, and identify the robot from its logs again",
        )
    plain = tuple(name for name in names if name != FLEXIBLE)
    model = with_widths(standard_model(robot, plain), tuple(document["coulomb_smoothing_widths"]))
    if FLEXIBLE not in names:
        return model
    return model.with_term(
        FlexibleJoints(tuple(row["joint"] for row in document["estimation"]["flexible_joints"]))
    )


def _spring_remarks(model: DynamicModel) -> list[str]:
    """Say of flexible joints that files of rigid robots hold no springs."""
    joints = ", ".join(str(joint + 1) for joint in flexible_joints(model))
    if not joints:
        return []
    return [f"Joints with a spring between motor and link: {joints}. Files of rigid robots hold no springs."]


def _uncorrected_model(document: Document) -> IdentifiedRobot:
    """Give the model as it was identified, before any correction."""
    document = plain_document(document)
    model = model_of_result(document, _robot(document["robot"]))
    rows = {row["name"]: row for row in document["standard_parameters"]}
    own = [rows[parameter.name] for parameter in model.parameters]
    essential = document["provenance"]["options"].get("essential")
    return IdentifiedRobot(
        model=model,
        standard=np.array([float(row["value"]) for row in own]),
        identifiable=tuple(row["identifiable"] for row in own),
        base=_base_values(document),
        remarks=(*answer_remarks(document), *([ESSENTIAL] if essential else []), *_spring_remarks(model)),
    )


def _extended_model(document: Document) -> IdentifiedRobot | None:
    """Read the model that a diagnosis extended; None where nothing joined it."""
    diagnosis = document.get("diagnosis") or {}
    written = diagnosis.get("after", {}).get("model")
    if written is None:
        return None
    extended = model_from_document(written)
    model = replace(extended.model, robot=_orthonormal(extended.robot))
    remarks = (*answer_remarks(document), *extended.remarks)
    return replace(extended, model=model, remarks=remarks)


def _kept_apart(model: DynamicModel) -> tuple[str, ...]:
    """Say which changes the model's file holds as terms of their own; everywhere else they are added."""
    changed = sorted({name for names in parts_of(model).values() for name in names})
    sentence = (
        f"What the findings change of {', '.join(changed)} is in terms of its own in this file, and not in "
        "these parameters; in every other file it is added to them."
    )
    return (sentence,) if changed else ()


def _answer_base(document: Document, extended: IdentifiedRobot) -> tuple[BaseValue, ...]:
    """Give the base parameters as the result states them; earlier results state those of the model's file."""
    if model_name(document) != EXTENDED:
        return extended.base
    return _base_values(document)


def _base_values(document: Document) -> tuple[BaseValue, ...]:
    return tuple(
        BaseValue(row["name"], row["unit"], row["value"], row["grouping"])
        for row in document["base_parameters"]
    )


def _robot(description: object) -> RobotModel:
    return _orthonormal(robot_from_description(description))


def _orthonormal(robot: RobotModel) -> RobotModel:
    """Make rotations of matrices that a document holds with ten digits: files hold exact angles."""
    links = tuple(
        link if link.row is not None else replace(link, rotation=nearest_rotation(link.rotation))
        for link in robot.links
    )
    return replace(robot, links=links)


def _names_of(parameters: Iterable[Parameter]) -> list[str]:
    return [parameter.name for parameter in parameters]


def _model_of(robot: RobotModel, terms: set[str]) -> DynamicModel:
    """Give the standard model of a robot with some of its terms."""
    return standard_model(robot, tuple(name for name in named_terms(standard_model(robot)) if name in terms))


def _standard_part(
    extended: IdentifiedRobot, robot: RobotModel, repaired: set[str], remarks: list[str]
) -> IdentifiedRobot:
    """Take the standard terms out of an extended model, with what belongs into their parameters."""
    model, standard = fold(extended.model, extended.standard)
    known = dict(zip(_names_of(extended.model.parameters), extended.identifiable, strict=True))
    values: dict[str, float] = {}
    widths: tuple[float, ...] = ()
    couplings = list(robot.couplings)
    held_terms: set[str] = set()
    beyond: list[str] = []
    for term, own in model.split(standard):
        if isinstance(term, (*STANDARD_TERMS.values(), MissingRotor, MissingCoupling)):
            values |= dict(zip(_names_of(term.parameters(model.robot)), map(float, own), strict=True))
            held_terms.add(_STANDARD_NAME.get(type(term), term.name))
            widths = getattr(term, "widths", ()) if isinstance(term, Coulomb) else widths
            couplings += _new_couplings(term, couplings)
        elif getattr(term, "kind", "") not in repaired:
            beyond.append(term.name)
    held = with_widths(_model_of(_declare(robot, values, tuple(couplings)), held_terms), widths)
    names = _names_of(held.parameters)
    if beyond:
        remarks = [*remarks, f"The extended model also has {', '.join(beyond)}; model.json holds these too."]
    return IdentifiedRobot(
        model=held,
        standard=np.array([values.get(name, 0.0) for name in names]),
        identifiable=tuple(known.get(name, "no") for name in names),
        base=extended.base,
        remarks=(*extended.remarks, *remarks),
    )


def _new_couplings(term: object, couplings: list[Coupling]) -> list[Coupling]:
    if not isinstance(term, MissingCoupling):
        return []
    return [] if term.coupling.number in {known.number for known in couplings} else [term.coupling]


def _declare(robot: RobotModel, values: Mapping[str, float], couplings: tuple[Coupling, ...]) -> RobotModel:
    """Let a robot declare the rotors and couplings that have numbers."""
    joints = tuple(
        replace(joint, rotor_inertia=f"IA{number}" in values)
        for number, joint in enumerate(robot.joints, start=1)
    )
    return replace(robot, joints=joints, couplings=couplings)
