"""Write the reader's list of torque terms from the terms themselves, so that the document cannot drift.

What a term is stands in its module, its parameters with their units in its class; `make reference` writes
docs/terms.md from them, and a test compares the two.
"""

import inspect
import sys
from collections.abc import Iterator
from importlib import import_module
from pkgutil import iter_modules

from ..robot.description import robot_from_description
from . import terms
from .model import STANDARD_TERMS, DynamicModel
from .terms.effect import AllJointsTerm, OneJointTerm

OPENING = """\
# Terms

Written by `make reference` from the files of `core/dynamics/terms`; change those, not this page.

A model is a robot and a list of terms; every term is linear in its parameters. A parameter's name is its
symbol and the number of its joint or link, `ZZ3`. Those that cannot be negative are held so by the
programme.

## Terms of the standard model

The option `terms` chooses among them; all that the robot declares are there by default.
"""
FURTHER = """
## Terms that a diagnosis adds

Each stands for the [cause](causes.md) of its name, on the joint that the finding names. Numbers in
*scanned* are not linear: they are looked for first and settled when the term joins the model.

| term | what its torque is | parameters | scanned |
|---|---|---|---|
"""
_SPECIMEN = {
    "name": "specimen",
    "joints": [
        {"type": "revolute", "alpha": 0.0, "d": 0.0, "r": 0.0, "theta_offset": 0.0},
        {"type": "revolute", "alpha": 1.5, "d": 0.0, "r": 0.0, "theta_offset": 0.0},
    ],
    "couplings": [{"name": "wrist", "joints": [1, 2], "weights": [1.0, 1.0]}],
}
"""A robot that has every parameter of the standard model."""
_NOT_SCANNED = {"joint", "believed", "robot"}
_WITHOUT_CAUSE = ("", "unlisted")

Effect = type[OneJointTerm] | type[AllJointsTerm]


def guide() -> str:
    """Write the document in Markdown."""
    standard = "".join(_standard(name) for name in STANDARD_TERMS)
    further = "".join(_further(one) for one in sorted(_effects(), key=lambda one: (one.kind, one.__name__)))
    return f"{OPENING}{standard}{FURTHER}{further}"


def _standard(name: str) -> str:
    robot = robot_from_description(_SPECIMEN)
    listed = DynamicModel(robot, (STANDARD_TERMS[name](),)).parameters
    units = {one.symbol: (one.unit, "no" if one.lower is not None else "yes") for one in listed}
    rows = "".join(f"| `{symbol}` | {unit} | {negative} |\n" for symbol, (unit, negative) in units.items())
    told = _sentence(inspect.getmodule(STANDARD_TERMS[name]))
    return f"\n### {name}\n\n{told}\n\n| parameter | unit | may be negative |\n|---|---|---|\n{rows}"


def _effects() -> Iterator[Effect]:
    """Go through the classes of the folder that stand for a cause, each where it is defined."""
    for found in iter_modules(terms.__path__, f"{terms.__name__}."):
        for one in vars(import_module(found.name)).values():
            own = inspect.isclass(one) and one.__module__ == found.name
            if own and issubclass(one, OneJointTerm | AllJointsTerm) and one.kind not in _WITHOUT_CAUSE:
                yield one


def _further(one: Effect) -> str:
    symbols: object = one.symbols
    known = symbols if isinstance(symbols, tuple) else ()  # of some the unit depends on the joint
    numbers = ", ".join(f"`{name}` ({'no unit' if unit == '1' else unit})" for name, unit, _ in known)
    scanned = ", ".join(f"`{name}`" for name in _scanned(one))
    told = _sentence(one)
    link = f"[`{one.kind}`](causes.md#{one.kind})"
    return f"| {link} | {told} | {numbers or 'as the cause has them'} | {scanned} |\n"


def _scanned(one: Effect) -> list[str]:
    return [
        name
        for name, kind in inspect.get_annotations(one).items()
        if kind in (float, int) and name not in _NOT_SCANNED
    ]


def _sentence(documented: object) -> str:
    """Give what a term is, without the verb of the code."""
    told = " ".join((inspect.getdoc(documented) or "").split("\n\n")[0].split())
    told = told.removeprefix("Give ").removeprefix("Model ")
    return told[:1].upper() + told[1:]


if __name__ == "__main__":
    sys.stdout.write(guide())
