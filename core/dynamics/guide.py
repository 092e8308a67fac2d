"""Write docs/terms.md from the terms themselves, so that the document cannot drift.

The effect is in a term's module, parameters with their units in its class. `make reference` writes the page,
and a test compares the two.
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
symbol and the number of its joint or link, `ZZ3`. The programme constrains parameters that cannot be
negative.

## Terms of the standard model

The option `terms` chooses among them; by default, all that the robot declares are used.
"""
FURTHER = """
## Terms that a diagnosis adds

Each stands for the [cause](causes.md) of its name, on the joint that the finding names. Numbers in
*scanned* are nonlinear: they are estimated first and fixed when the term is added to the model.

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
    effects = sorted(_effects(), key=lambda effect: (effect.kind, effect.__name__))
    further = "".join(_further(effect) for effect in effects)
    return f"{OPENING}{standard}{FURTHER}{further}"


def _standard(name: str) -> str:
    robot = robot_from_description(_SPECIMEN)
    listed = DynamicModel(robot, (STANDARD_TERMS[name](),)).parameters
    units = {
        parameter.symbol: (parameter.unit, "no" if parameter.lower is not None else "yes")
        for parameter in listed
    }
    rows = "".join(f"| `{symbol}` | {unit} | {negative} |\n" for symbol, (unit, negative) in units.items())
    effect = _sentence(inspect.getmodule(STANDARD_TERMS[name]))
    return f"\n### {name}\n\n{effect}\n\n| parameter | unit | may be negative |\n|---|---|---|\n{rows}"


def _effects() -> Iterator[Effect]:
    """List the classes of the folder that belong to a cause, each where it is defined."""
    for found in iter_modules(terms.__path__, f"{terms.__name__}."):
        for effect in vars(import_module(found.name)).values():
            own = inspect.isclass(effect) and effect.__module__ == found.name
            if own and issubclass(effect, OneJointTerm | AllJointsTerm) and effect.kind not in _WITHOUT_CAUSE:
                yield effect


def _further(effect: Effect) -> str:
    symbols: object = effect.symbols
    known = symbols if isinstance(symbols, tuple) else ()  # of some the unit depends on the joint
    numbers = ", ".join(f"`{name}` ({'no unit' if unit == '1' else unit})" for name, unit, _ in known)
    scanned = ", ".join(f"`{name}`" for name in _scanned(effect))
    link = f"[`{effect.kind}`](causes.md#{effect.kind})"
    return f"| {link} | {_sentence(effect)} | {numbers or 'as the cause has them'} | {scanned} |\n"


def _scanned(effect: Effect) -> list[str]:
    return [
        name
        for name, kind in inspect.get_annotations(effect).items()
        if kind in (float, int) and name not in _NOT_SCANNED
    ]


def _sentence(documented: object) -> str:
    """Give the first paragraph of a docstring, without its verb."""
    text = " ".join((inspect.getdoc(documented) or "").split("\n\n")[0].split())
    text = text.removeprefix("Give ").removeprefix("Model ")
    return text[:1].upper() + text[1:]


if __name__ == "__main__":
    sys.stdout.write(guide())
