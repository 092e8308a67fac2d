"""Lay out a run: which cases are drawn from a seed, and how one of them is put before the diagnosis."""

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import count
from typing import Any

from tests.hidden.score import Score, score
from tests.plant.cache import kept
from tests.plant.cases import Case, ImpossibleError, draw, draw_clean, draw_foreign
from tests.plant.effects.registry import EFFECTS
from tests.plant.sensors import NOISES

STRENGTHS = (1.0, 3.0, 0.3)
KINDS = (
    "single",
    "single",
    "combination",
    "single",
    "clean",
    "single",
    "combination",
    "single",
    "foreign",
    "single",
)
"""What ten cases in a row are."""
EACH_CAUSE = {1.0: 20, 3.0: 3, 0.3: 3}
"""How often the whole examination hides every cause, by strength."""
COMBINATIONS, CLEAN, STRANGE = 40, 300, 60
"""How many combinations, clean logs and effects that are in no list it has."""
SHORT = 15.0
"""Seconds of a log of a quick run: half of the usual."""
SHORT_KINDS = (
    (50, "combination", "planar-2", 4),
    (60, "clean", "planar-2", 3),
    (70, "foreign", "planar-2", 3),
    (80, "combination", "planar-3", 2),
    (85, "clean", "planar-3", 1),
    (90, "foreign", "planar-3", 1),
)
"""What a quick run has beside every cause: its first number, the arm, and how many there are."""

EFFECT_OF = {
    "gear_ratio": "torque_gain",
    "unit": "torque_gain",
    "mounting": "gravity_misalignment",
    "link_length": "kinematic_error",
    "zero_quarter_turn": "encoder_offset",
    "zero_offset": "encoder_offset",
}
"""The effect that a corrected set-up is, where it is a large one of a listed kind."""


@dataclass(frozen=True)
class Order:
    """Ask for one case."""

    kind: str
    seed: int
    cause: str | None = None
    strength: float = 1.0
    effects: int = 1
    noise: str | None = None
    robot: str | None = None
    duration: float | None = None


def orders(
    seed: int, cases: int, *, strength: float | None = None, cause: str | None = None, kind: str | None = None
) -> list[Order]:
    """Lay out a run: causes, strengths, noises and kinds take turns, so that tables fill evenly.

    A given cause asks for single effects; a given kind for nothing else.
    """
    causes = list(EFFECTS)
    listed = []
    singles = 0
    for number in range(cases):
        own = 100_000 * seed + number
        what = kind or ("single" if cause else KINDS[number % len(KINDS)])
        noise = NOISES[(number if kind else number // len(KINDS)) % len(NOISES)] if what == "clean" else None
        name = cause or causes[(singles + 7 * seed) % len(causes)] if what == "single" else None
        size = strength or (STRENGTHS[singles % len(STRENGTHS)] if what == "single" else 1.0)
        effects = 2 + number // 3 % 2 if what == "combination" else 1
        singles += what == "single"
        listed.append(Order(what, own, name, size, effects, noise))
    return listed


def battery(seed: int) -> list[Order]:
    """Lay out the whole examination: every cause 20 times, and enough of all else to know its rates."""
    own = count(100_000 * seed)
    listed = [
        Order("single", next(own), cause, strength)
        for strength, times in EACH_CAUSE.items()
        for _ in range(times)
        for cause in EFFECTS
    ]
    listed += [Order("combination", next(own), None, 1.0, 2 + place % 2) for place in range(COMBINATIONS)]
    listed += [
        Order("clean", next(own), noise=noise) for _ in range(CLEAN // len(NOISES)) for noise in NOISES
    ]
    return listed + [Order("foreign", next(own)) for _ in range(STRANGE)]


def quick(seed: int) -> list[Order]:
    """Lay out short logs of small arms: every cause once, combinations, clean logs, foreign effects."""
    own = 900 * seed
    listed = [Order("single", own + place, cause, robot="planar-2") for place, cause in enumerate(EFFECTS)]
    for first, kind, robot, cases in SHORT_KINDS:
        listed += [
            Order(kind, own + first + place, effects=2 + place % 2, robot=robot) for place in range(cases)
        ]
    return [replace(order, duration=SHORT) for order in listed]


def drawn(order: Order) -> Case:
    """Draw the case that was ordered."""
    if order.kind == "clean":
        return kept(draw_clean, order.seed, noise=order.noise, **_options(order))
    if order.kind == "foreign":
        return kept(draw_foreign, order.seed, order.strength, **_options(order))
    return kept(draw, order.seed, order.cause, order.strength, effects=order.effects, **_options(order))


def _options(order: Order) -> dict[str, str | float]:
    wanted = {"robot": order.robot, "duration": order.duration}
    return {name: value for name, value in wanted.items() if value is not None}


def answered(case: Case, options: Mapping[str, object] | None = None) -> Mapping[str, Any]:
    """Ask for a diagnosis of the case's log; give the `diagnosis` of the result document.

    A set-up that was corrected stands among its findings, by the name that an effect of its kind has: whoever
    says that a torque is off by a ratio has named the gain, and an exchanged channel is a false answer.
    """
    from veritorque.core.study import IdentifyRequest, diagnose

    # Deviations from drawn blocks are the identification's, and nothing here looks at them.
    document = diagnose(IdentifyRequest(case.believed, (case.log,), options or {"bootstrap": {"draws": 0}}))
    found = document["diagnosis"]
    conflicts = document["conflicts"]
    assert isinstance(found, dict)
    assert isinstance(conflicts, list)
    return {**found, "findings": [*map(_as_finding, conflicts), *found["findings"]]}


def _as_finding(conflict: Mapping[str, Any]) -> Mapping[str, Any]:
    own, *others = (
        {**one, "cause": EFFECT_OF.get(one["conflict"], one["conflict"])}
        for one in (conflict, *conflict["ambiguous_with"])
    )
    return {**own, "ambiguous_with": others, "parameters": []}


def run(order: Order) -> tuple[Order, Score | None]:
    """Draw a case, ask, and score the answer; no score where no such case can be drawn."""
    try:
        case = drawn(order)
    except ImpossibleError:
        return order, None
    begun = time.process_time()
    try:
        answer = answered(case)
    except Exception as error:  # noqa: BLE001 - a failure is an answer, too, and the worst one
        answer = {"verdict": f"failed: {error}", "findings": []}
    found = score(answer, case.truth, kind=order.kind, noise=case.noise, seed=order.seed)
    return order, replace(found, seconds=time.process_time() - begun)
