"""Write a dynamic model with its numbers as JSON that loads back to an equal model, extended or not.

No other format holds what a diagnosis adds: friction with its own curves, compliant gears, faults of the
torque channel. The file is self-contained: the robot, the terms with what they were made with, one value per
parameter, and the predictions that some terms are built on.
"""

import json
from collections.abc import Mapping, Sequence
from itertools import chain
from operator import itemgetter
from typing import Any

import numpy as np

from ...dynamics.model import DynamicModel
from ...dynamics.prediction import Prediction
from ...errors import RobotError
from ...robot.description import robot_from_description
from ...robot.writing import to_description
from .caveats import REPRESENTATIVE, SOURCE
from .identified import BaseValue, IdentifiedRobot
from .terms import term_fields, term_of

FORMAT, FORMAT_VERSION = "veritorque-model", "1.0"
Document = Mapping[str, Any]


def write_model(identified: IdentifiedRobot) -> str:
    """Write the model's file.

    Raises
    ------
    RobotError
        If the robot's joints are numbered against the order of their links.
    """
    return json.dumps(model_document(identified), indent=1, allow_nan=False) + "\n"


def read_model(text: str | bytes) -> IdentifiedRobot:
    """Read a model's file.

    Raises
    ------
    RobotError
        If the text is no such file, or holds what does not belong together.

    Examples
    --------
    >>> from veritorque.core.robot.builtin import builtin_robot
    >>> from veritorque.core.dynamics.model import standard_model
    >>> model = standard_model(builtin_robot("yumi-left"), ("viscous",))
    >>> numbers = np.arange(7.0)
    >>> text = write_model(IdentifiedRobot(model, numbers, ("individually",) * 7))
    >>> read_model(text).values["FV7"]
    6.0
    """
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise _unusable("is no JSON", str(error)) from error
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise _unusable("is not one of Veritorque's", f"format {str(document)[:40]}")
    if document.get("format_version") != FORMAT_VERSION:
        raise _unusable("is of another version", f"version {document.get('format_version')}")
    return model_from_document(document)


def model_document(identified: IdentifiedRobot) -> dict[str, object]:
    """Write the model as JSON data."""
    predictions: list[Prediction] = []
    terms = _terms(identified.model, identified.standard, predictions, identified.identifiable)
    return {
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "notes": [SOURCE, REPRESENTATIVE, *identified.remarks],
        "remarks": list(identified.remarks),
        "robot": to_description(identified.robot),
        "terms": terms,
        "beliefs": _prediction_rows(predictions),
        "base_parameters": [vars(value) for value in identified.base],
    }


def model_from_document(document: Document) -> IdentifiedRobot:
    """Read the model from JSON data.

    Raises
    ------
    RobotError
        If something is missing, or does not belong together.
    """
    try:
        predictions: list[Prediction] = []
        for row in document["beliefs"]:
            model, standard = _model(row, predictions)
            joined, values = _model({"robot": row["robot"], "terms": row["joined"]}, predictions)
            predictions.append(Prediction(model, standard, joined=joined.split(values)))
        model, standard = _model(document, predictions)
        return IdentifiedRobot(
            model=model,
            standard=standard,
            identifiable=tuple(
                str(row["identifiable"]) for term in document["terms"] for row in term["parameters"]
            ),
            base=tuple(
                BaseValue(row["name"], row["unit"], row["value"], row["grouping"])
                for row in document["base_parameters"]
            ),
            remarks=tuple(document["remarks"]),
        )
    except (KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
        raise _unusable("does not hold what it must", f"{type(error).__name__}: {error}") from error


def _prediction_rows(predictions: list[Prediction]) -> list[dict[str, object]]:
    """Write predictions; what joined their models is built on those before them."""
    written: list[dict[str, object]] = []
    for prediction in predictions:
        inner: list[Prediction] = []
        terms = _terms(prediction.model, prediction.standard, inner)
        if inner:
            raise RobotError(
                "a prediction is built on another one, which the file cannot say",
                evidence={"terms": [term.name for term in prediction.model.terms]},
                remedy="compare with a standard model",
            )
        joined = DynamicModel(prediction.model.robot, tuple(term for term, _ in prediction.joined))
        values = np.concatenate([np.zeros(0), *(values for _, values in prediction.joined)])
        written.append(
            {
                "robot": to_description(prediction.model.robot),
                "terms": terms,
                "joined": _terms(joined, values, predictions),
            }
        )
    return written


def _terms(
    model: DynamicModel,
    standard: np.ndarray,
    predictions: list[Prediction],
    identifiable: Sequence[str] | None = None,
) -> list[dict[str, object]]:
    known = iter(identifiable or ())
    return [
        {
            "term": type(term).__name__,
            "name": term.name,
            "made_with": term_fields(term, predictions),
            "parameters": [
                {"name": parameter.name, "unit": parameter.unit, "value": float(value)}
                | ({"identifiable": next(known)} if identifiable else {})
                for parameter, value in zip(term.parameters(model.robot), values, strict=True)
            ],
        }
        for term, values in model.split(standard)
    ]


def _model(document: Document, predictions: Sequence[Prediction]) -> tuple[DynamicModel, np.ndarray]:
    robot = robot_from_description(document["robot"])
    rows: list[Document] = list(chain.from_iterable(map(itemgetter("parameters"), document["terms"])))
    terms = tuple(term_of(str(term["term"]), term["made_with"], predictions) for term in document["terms"])
    model = DynamicModel(robot, terms)
    names = [parameter.name for parameter in model.parameters]
    if names != [row["name"] for row in rows]:
        raise _unusable("holds other parameters than its terms have", f"wanted {names}"[:200])
    standard = np.array([float(row["value"]) for row in rows])
    if not np.isfinite(standard).all():
        raise _unusable("holds a parameter that is not finite", str(standard)[:200])
    return model, standard


def _unusable(what: str, seen: str) -> RobotError:
    return RobotError(
        f"the model file {what}",
        evidence={"seen": seen[:200]},
        remedy="give the file model.json as a job's results offer it",
    )
