"""Make the known cases again without the search for their sizes, which costs several simulations each.

Beside the arguments of `draw`, the file says in which of the seed's worlds the effects were found, and what
they and their strengths are. The world is drawn, moved once and logged; nothing differs from a search. Run
``python -m tests.plant.known`` after a change of the plant, or to fill in a case that is listed with null.
"""

import json
import sys
from collections.abc import Mapping
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from tests.plant.cases import Case, case_of, draw, draw_world, truth_of
from tests.plant.effects.effect import Effect
from tests.plant.effects.registry import EFFECTS, FOREIGN

FILE = Path(__file__).with_name("known.json")
OF_THE_WORLD = ("noise", "robot", "rate_hz", "duration")
"""The options of `draw` that decide the world."""


def known_case(asked: str) -> Case | None:
    """Make the case that is listed under these arguments (JSON: function, arguments, options), if one is."""
    recorded = known().get(asked)
    if recorded is None:
        return None
    _, (seed, *_), options = json.loads(asked)
    world = {name: value for name, value in options if name in OF_THE_WORLD}
    rng = np.random.default_rng([seed, recorded["attempt"]])
    hidden = [_effect(**one) for one in recorded["hidden"]]
    measured = ((one["strength"], one["noncentrality"]) for one in recorded["hidden"])
    truth = tuple(truth_of(one, *sizes) for one, sizes in zip(hidden, measured, strict=True))
    return case_of(draw_world(rng, seed, **world), tuple(hidden), truth)


@cache
def known() -> Mapping[str, Any]:
    """Read the list."""
    listed: Mapping[str, Any] = json.loads(FILE.read_text(encoding="utf-8"))
    return listed


def searched(asked: str) -> dict[str, Any]:
    """Search for the sizes of a case, and give what is recorded of it."""
    _, arguments, options = json.loads(asked)
    case = draw(*arguments, **dict(options))
    return {
        "attempt": case.attempt,
        "hidden": [
            {
                "cause": truth.cause,
                "numbers": asdict(effect),
                "strength": truth.strength,
                "noncentrality": truth.noncentrality,
            }
            for effect, truth in zip(case.effects, case.truth, strict=True)
        ],
    }


def _effect(cause: str, numbers: Mapping[str, Any], **_measured: float) -> Effect:
    return (EFFECTS | FOREIGN)[cause](**{name: _tuples(value) for name, value in numbers.items()})


def _tuples(value: Any) -> Any:
    return tuple(map(_tuples, value)) if isinstance(value, list) else value


def main() -> int:
    """Search for every listed case anew and write the list."""
    text = json.dumps({asked: searched(asked) for asked in known()}, indent=1)
    FILE.write_text(text + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
