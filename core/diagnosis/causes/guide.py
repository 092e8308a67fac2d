"""Write the reader's list of causes from the causes themselves, so that the document cannot drift.

What a cause is, its numbers, what it is confused with and which motion would tell stand in the cause's own
file; `make reference` writes docs/causes.md from them, and a test compares the two.
"""

import inspect
import sys
from collections.abc import Mapping

from .imitation import Imitation, imitations
from .protocol import Cause
from .registry import BY_ID, ONLY_CHANGES
from .repairs import corrects
from .sample_check import SampleCheck

OPENING = """\
# Causes

Written by `make reference` from the files of `core/diagnosis/causes`; change those, not this page.

A finding of a diagnosis names one of these causes and the joint that it acts on. Where two of them explain a
log equally well, the other one is named beside it (`ambiguous_with`) with the experiment that separates them.
Where the log could not have shown a cause, the result says so (`not_identifiable`), with the experiment that
would. Besides `causes_found`, a verdict may be `nothing_found` (the residual is noise) or `unexplained`: a
generic learner still predicts part of the residual on blocks that it has not seen, and no cause of this list
explains that part.

What a finding cures is one of three things, which are the three ways a simulation can be wrong. Its repair is
what a user can take: of the `robot`'s description, of the `log`, of the `model` alone (a further term), or of
`nothing`, where what was lost cannot be brought back ([repairs](diagnosis.md#repairs)).

| cure | what is wrong | what is done |
|---|---|---|
"""
CURES: Mapping[str, tuple[str, str]] = {
    "term": (
        "a term is missing",
        "its torque joins the model, and all parameters are identified again under the same constraints",
    ),
    "signal": (
        "a signal lies",
        "where it bends the torque, what it does joins the model as a term; the repair mends the log",
    ),
    "robot": (
        "the robot is not the one described",
        "what the difference does joins the model as a term; the repair is the corrected description",
    ),
}
ONLY_AGAINST = """\
Only against a [reference](diagnosis.md#what-has-changed): where everything is identified anew it is absorbed.

"""
OVERVIEW = """
## All of them

| cause | what it is | cure | repair |
|---|---|---|---|
"""


def guide() -> str:
    """Write the document in Markdown."""
    cures = "".join(f"| {cure} | {wrong} | {done} |\n" for cure, (wrong, done) in CURES.items())
    only = {one.id: ", only against a reference" for one in ONLY_CHANGES}
    rows = "".join(
        f"| [{name}](#{name}) | {one.title}{only.get(name, '')} | {one.cure} | {_repair(one)} |\n"
        for name, one in BY_ID.items()
    )
    return OPENING + cures + OVERVIEW + rows + "".join(_section(one) for one in BY_ID.values())


def _section(cause: Cause | SampleCheck) -> str:
    suspected = " ".join((inspect.getdoc(inspect.getmodule(cause)) or "").split("\n\n")[0].split())
    units = "".join(f"| {name} | {_written(unit)} |\n" for name, unit in cause.units)
    return (
        f"\n## {cause.id}\n\n"
        f"What is suspected: {suspected.removeprefix('Suspect ')}\n\n"
        f"{ONLY_AGAINST * (cause in ONLY_CHANGES)}"
        f"| number | unit |\n|---|---|\n{units}\n"
        f"Shown by: {cause.experiment}.\n\n"
        "Confused with:\n\n" + "".join(_imitation(*entry) for entry in imitations(cause.id).items())
    )


def _repair(cause: Cause | SampleCheck) -> str:
    return "nothing" if isinstance(cause, SampleCheck) else corrects(cause)


def _imitation(other: str, entry: Imitation) -> str:
    return f"- [{other}](#{other}): {entry.why}. To separate them, {entry.experiment}.\n"


def _written(unit: str) -> str:
    """Write a unit for a table; numbers without one are said to have none."""
    return "none" if unit == "1" else unit


if __name__ == "__main__":
    sys.stdout.write(guide())
