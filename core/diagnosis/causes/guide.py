"""Write docs/causes.md from the causes themselves, so that the document cannot drift.

What a cause is, its numbers and the motion that shows it are in its own file, what it imitates in
`imitation`. `make reference` writes the page, and a test compares the two.
"""

import inspect
import sys
from collections.abc import Mapping

from .exclusion import GENERAL, Exclusion, doubts, exclusions
from .imitation import Imitation, imitations
from .protocol import Cause
from .registry import BY_ID, ONLY_CHANGES
from .repairs import corrects
from .sample_check import SampleCheck

OPENING = """\
# Causes

Written by `make reference` from the files of `core/diagnosis/causes`; change those, not this page.

A finding of a diagnosis names one of these causes and the joint that it acts on. Where two of them explain a
log equally well, the other one is listed beside it (`ambiguous_with`) with the experiment that separates
them. Where the log could not have shown a cause, the result lists it (`not_identifiable`) with the experiment
that would. Besides `causes_found`, a verdict may be `nothing_found` (the residual is noise) or `unexplained`:
a generic learner predicts part of the residual on held-out blocks, and no cause of this list explains that
part.

A simulation can be wrong in three ways: `cure` says in which. A finding's repair corrects the `robot`'s
description, the `log`, the `model` alone (by a further term), or `nothing`, where the samples are lost
([repairs](diagnosis.md#repairs)).

| cure | what is wrong | what is done |
|---|---|---|
"""
CURES: Mapping[str, tuple[str, str]] = {
    "term": (
        "a term is missing",
        "its term is added to the model, and all parameters are identified again under the same constraints",
    ),
    "signal": (
        "a signal is wrong",
        "where it changes the torque, its effect is added as a term; the repair corrects the log",
    ),
    "robot": (
        "the robot's description is wrong",
        "the effect of the error is added to the model as a term; the repair is the corrected description",
    ),
}
ONLY_AGAINST = """\
Only against a [reference](diagnosis.md#what-has-changed): without one, the base parameters absorb it.

"""
EXCLUDED = """
### What is never named

The structure of robot, motion and channel excludes names, whatever the likelihood says. No cause is named
where

"""
OVERVIEW = """
## All of them

| cause | what it is | cure | repair |
|---|---|---|---|
"""


def guide() -> str:
    """Write the document in Markdown."""
    cures = "".join(f"| {cure} | {wrong} | {done} |\n" for cure, (wrong, done) in CURES.items())
    only = {cause.id: ", only against a reference" for cause in ONLY_CHANGES}
    rows = "".join(
        f"| [{name}](#{name}) | {cause.title}{only.get(name, '')} | {cause.cure} | {_repair(cause)} |\n"
        for name, cause in BY_ID.items()
    )
    never = "".join(f"- {law};\n" for law in GENERAL[:-1]) + f"- {GENERAL[-1]}.\n"
    return (
        OPENING
        + cures
        + OVERVIEW
        + rows
        + EXCLUDED
        + never
        + "".join(_section(cause) for cause in BY_ID.values())
    )


def _section(cause: Cause | SampleCheck) -> str:
    opening = " ".join((inspect.getdoc(inspect.getmodule(cause)) or "").split("\n\n")[0].split())
    hypothesis = opening.removeprefix("Candidate cause: ")
    units = "".join(f"| {name} | {_written(unit)} |\n" for name, unit in cause.units)
    return (
        f"\n## {cause.id}\n\n"
        f"{hypothesis[0].upper()}{hypothesis[1:]}\n\n"
        f"{ONLY_AGAINST * (cause in ONLY_CHANGES)}"
        f"| number | unit |\n|---|---|\n{units}\n"
        f"Shown by: {cause.experiment}.\n\n"
        f"{_excluded(cause.id)}"
        "May be mistaken for:\n\n" + "".join(_imitation(*entry) for entry in imitations(cause.id).items())
    )


def _excluded(cause: str) -> str:
    parts = (
        ("Never named where:", exclusions(cause)),
        ("Doubtful, with a confidence of 0.5 at most, where:", doubts(cause)),
    )
    return "".join(f"{title}\n\n{''.join(map(_row, entries))}\n" for title, entries in parts if entries)


def _row(entry: Exclusion) -> str:
    return f"- {entry.where}: {entry.law}.\n"


def _repair(cause: Cause | SampleCheck) -> str:
    return "nothing" if isinstance(cause, SampleCheck) else corrects(cause)


def _imitation(other: str, entry: Imitation) -> str:
    return f"- [{other}](#{other}): {entry.why}. To separate them, {entry.experiment}.\n"


def _written(unit: str) -> str:
    """Write a unit for a table, and none for a number without one."""
    return "none" if unit == "1" else unit


if __name__ == "__main__":
    sys.stdout.write(guide())
