"""Read from a result document which model is its answer.

`extended.answer_fields` decides it when a document is written; every file, page and client asks here. The
plain model stands beside an extended one under its own name, `plain`.
"""

from collections.abc import Mapping
from typing import Any

Document = Mapping[str, Any]
PLAIN, EXTENDED = "plain", "extended"
"""What the field `model` of a result calls its answer."""
BEFORE = "The plain model, before what the diagnosis added"


def plain_document(document: Document) -> dict[str, Any]:
    """Give a result document with the plain model for its answer: the one before any correction."""
    plain = document.get("plain")
    if plain is None:
        return dict(document)
    return {**document, **plain, "model": {"name": PLAIN, "statement": BEFORE}, "plain": None}


def model_name(document: Document) -> str:
    """Name the model that a result's parameters are of: ``plain`` or ``extended``."""
    return str((document.get("model") or {}).get("name", PLAIN))


def answer_remarks(document: Document) -> tuple[str, ...]:
    """Say in the files of a diagnosis which model they hold."""
    statement = (document.get("model") or {}).get("statement")
    return () if statement is None or not document.get("diagnosis") else (f"{statement}.",)
