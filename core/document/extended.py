"""Decide which model is a study's answer, and write it with the plain model beside it.

The answer is the extended model where a diagnosis extended the plain one, else the plain one.
"""

from ..extension.fold import folded, parts_of
from ..extension.result import Extension
from ..identification.result import Identification
from .identification import base_parameter_rows, model_fields
from .model.answer import EXTENDED, PLAIN

NOTHING_ADDED = "The plain model, as the robot's description states it: the diagnosis added nothing"


def answer_fields(found: Extension) -> dict[str, object]:
    """Give the fields of a result that describe its model: the answer's, and the plain model's beside it."""
    after = found.after
    if after is None:
        return {"model": {"name": PLAIN, "statement": NOTHING_ADDED}}
    return {
        **model_fields(folded(after)),
        "base_parameters": extended_rows(found.before, after),
        "model": {"name": EXTENDED, "statement": _statement(found.before, after)},
        "plain": model_fields(found.before),
    }


def extended_rows(before: Identification, after: Identification) -> list[dict[str, object]]:
    """Tabulate the base parameters of the extended model.

    What a finding changes throughout the log is added to the parameters it changes, as in the files of
    robots; a row of the change itself says by `part_of` where it is counted.
    """
    old, within = set(before.base.names), parts_of(after.base.model)
    return [
        row
        | {"new": row["name"] not in old}
        | ({"part_of": within[str(row["name"])]} if row["name"] in within else {})
        for row in base_parameter_rows(folded(after))
    ]


def _statement(before: Identification, after: Identification) -> str:
    old = {term.name for term in before.base.model.terms}
    added = ", ".join(term.name for term in after.base.model.terms if term.name not in old)
    return (
        f"The extended model: the diagnosis added {added} to the plain model, which the result holds beside "
        "it as `plain`"
    )
