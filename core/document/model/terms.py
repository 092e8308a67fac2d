"""Write torque terms as data and make them again, whatever effect they model.

A term is a frozen dataclass: its class's name and its fields say all of it. The one field that is no plain
value is the prediction that some effects are built on; it is a model with numbers, kept in a list of its own
and named by its place there, because many terms share it.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, fields, is_dataclass
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from typing import Any, cast

import numpy as np

from ...dynamics import terms as package
from ...dynamics.model import DynamicModel
from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...errors import RobotError
from ...robot.model import Coupling

NAME = "name"
"""The field of a standard term that never differs from its default."""


@cache
def known_terms() -> Mapping[str, type]:
    """List the classes of all torque terms by their name."""
    modules = [import_module(f"{package.__name__}.{found.name}") for found in iter_modules(package.__path__)]
    return {
        kind.__name__: kind
        for module in modules
        for kind in vars(module).values()
        if isinstance(kind, type) and kind.__module__ == module.__name__ and _is_term(kind)
    }


def named_terms(model: DynamicModel) -> list[str]:
    """Name the torque terms that have a parameter on the model's robot."""
    return [term.name for term in model.terms if term.parameters(model.robot)]


def term_fields(term: Term, predictions: list[Prediction]) -> dict[str, object]:
    """Write what a term was made with; predictions are appended to `predictions` unless they are there."""
    return {name: _json_value(getattr(term, name), predictions) for name, _ in _own_fields(type(term))}


def term_of(kind: str, values: Mapping[str, Any], predictions: Sequence[Prediction]) -> Term:
    """Make a term again.

    Raises
    ------
    RobotError
        If there is no such term, or it is not made with these fields.
    """
    known = known_terms()
    wanted = dict(_own_fields(known[kind])) if kind in known else {}
    if kind not in known or set(values) != set(wanted):
        fault = "is made of other fields" if kind in known else "is not known"
        raise RobotError(
            f"the model names a torque term that {fault}: {kind[:80]}",
            evidence={"fields": list(values)[:10], "wanted": list(wanted), "known": sorted(known)},
            remedy="read the file with the version that wrote it",
        )
    made = {name: _read(values[name], annotation, predictions) for name, annotation in wanted.items()}
    return cast("Term", known[kind](**made))


def _is_term(kind: type) -> bool:
    concrete = hasattr(kind, "series") and getattr(kind, "kind", None) != ""
    return is_dataclass(kind) and concrete


def _own_fields(kind: type) -> Iterator[tuple[str, object]]:
    return ((entry.name, entry.type) for entry in fields(kind) if entry.name != NAME)


def _place(prediction: Prediction, predictions: list[Prediction]) -> int:
    """Give a prediction's place among those of the document, and append it where it is missing."""
    if not any(known is prediction for known in predictions):
        for term, _ in prediction.joined:  # what it is built on comes before it
            term_fields(term, predictions)
        predictions.append(prediction)
    return next(index for index, known in enumerate(predictions) if known is prediction)


def _json_value(value: object, predictions: list[Prediction]) -> object:
    if isinstance(value, Prediction):
        return _place(value, predictions)
    if isinstance(value, Coupling):
        return asdict(value)
    if isinstance(value, tuple):
        return [_json_value(entry, predictions) for entry in value]
    if isinstance(value, float | np.floating):
        return float(value) if np.isfinite(value) else str(float(value))  # JSON knows no infinity
    return value


def _read(value: Any, annotation: object, predictions: Sequence[Prediction]) -> object:  # noqa: ANN401  (any JSON)
    if annotation is Prediction:
        return predictions[int(value)]
    if annotation is Coupling:
        joints, weights = _numbers(value["joints"], int), _numbers(value["weights"])
        return Coupling(str(value["name"]), int(value["number"]), joints, weights)
    if annotation is float:
        return float(value)
    if isinstance(value, list):
        return _numbers(value, int if annotation == tuple[int, ...] else float)
    return value


def _numbers(value: Any, kind: type[int | float] = float) -> tuple[Any, ...]:  # noqa: ANN401  (any JSON)
    """Read numbers, nested as they were."""
    return tuple(_numbers(entry, kind) if isinstance(entry, list) else kind(entry) for entry in value)
