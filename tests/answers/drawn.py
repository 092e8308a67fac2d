"""Ask for the diagnosis of drawn cases: every cause once, combinations, clean logs, effects in no list."""

from collections.abc import Callable, Mapping
from functools import partial

from tests.answers.product import Document, IdentifyRequest, diagnose
from tests.hidden.plan import Order, drawn
from tests.plant.effects.registry import EFFECTS
from tests.plant.sensors import NOISES

SEED = 7300
"""Decides every drawn case."""
CASES, COMBINATIONS, CLEAN = 60, 12, 6
"""How many there are in all, and of what; effects that are in no list fill up."""
STRENGTH = 3.0
"""How strong a single effect is; the seed is one with which a robot shows each cause so strongly."""


def orders() -> dict[str, Order]:
    """Lay out the drawn cases by name."""
    kinds = [("single", cause) for cause in EFFECTS]
    kinds += [("combination", str(place)) for place in range(COMBINATIONS)]
    kinds += [("clean", str(place)) for place in range(CLEAN)]
    kinds += [("foreign", str(place)) for place in range(CASES - len(kinds))]
    return {
        f"drawn-{kind}-{name}": _order(kind, 100_000 * SEED + place, name)
        for place, (kind, name) in enumerate(kinds)
    }


def _order(kind: str, seed: int, name: str) -> Order:
    if kind == "single":
        return Order(kind, seed, name, STRENGTH)
    if kind == "combination":
        return Order(kind, seed, effects=2 + int(name) % 2)
    return Order(kind, seed, noise=NOISES[int(name) % len(NOISES)] if kind == "clean" else None)


def asks() -> Mapping[str, Callable[[], Document]]:
    """List what is asked, by name."""
    return {name: partial(_diagnosed, order) for name, order in orders().items()}


def _diagnosed(order: Order) -> Document:
    drawn(order)
    case = drawn(order)  # read back from the folder of drawn cases: first and later runs see the same bits
    return diagnose(IdentifyRequest(case.believed, (case.log,), {"bootstrap": {"draws": 0}}))
