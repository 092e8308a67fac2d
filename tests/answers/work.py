"""Answer by name, so that another process can be asked; an error is an answer, too."""

import json
import time
from collections.abc import Callable
from dataclasses import dataclass

import pytest

from tests.answers import changes, drawn, examples, robots
from tests.answers.product import Document

QUICK = (
    "drawn-single-friction_stribeck",
    "drawn-single-torque_gain_nonlinear",
    "reference-friction",
    "prior-wrong",
    "yumi-diagnose-log",
    "yumi-identify-defaults",
    "yumi-identify-entropy",
    "yumi-identify-irls",
    "ur10e-identify-points",
    "tx40-identify-smooth",
    "refused-wrong-type",
)
"""A few telling answers that come fast."""


@dataclass(frozen=True)
class Answer:
    """Hold a result document, or why there is none, and the processor time that it took."""

    name: str
    document: Document | None
    seconds: float
    missing: str = ""


def asks() -> dict[str, Callable[[], Document]]:
    """List everything that is asked, by name; what takes longest first."""
    return {**robots.asks(), **examples.asks(), **changes.asks(), **drawn.asks()}


def answered(name: str) -> Answer:
    """Answer one ask; it is left out where its data are not there."""
    begun = time.process_time()
    document, missing = None, ""
    try:
        document = asks()[name]()
    except pytest.skip.Exception as left_out:  # public data that are not here: said with the answers
        missing = str(left_out)
    except Exception as error:  # noqa: BLE001 - what the product refuses is part of what it answers
        document = _refusal(error)
    whole = None if document is None else json.loads(json.dumps(document, default=str))
    return Answer(name, whole, time.process_time() - begun, missing)


def _refusal(error: Exception) -> Document:
    told = {name: getattr(error, name) for name in ("evidence", "remedy") if hasattr(error, name)}
    return {"error": type(error).__name__, "message": str(error)} | told
