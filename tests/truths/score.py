"""Ask for a diagnosis of a case, and compare what it names with what was changed."""

import time
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from tests.truths.cases import Case, Source, Truth
from veritorque.core.errors import VeritorqueError
from veritorque.core.study import IdentifyRequest, diagnose, identify

CONFIDENT = 0.8
"""Probability above which a wrong name is a confident one."""
NAMED = 0.5
"""Probability from which a right name is one that a user would act on."""
OPTIONS: Mapping[str, object] = {"bootstrap": {"draws": 0}}


@dataclass(frozen=True)
class Name:
    """Hold one name that was given."""

    cause: str
    joints: tuple[int, ...]
    confidence: float
    alternatives: tuple[tuple[str, tuple[int, ...]], ...]
    size: str

    def share_on(self, truths: tuple[Truth, ...]) -> float:
        """Give the probability that it puts on the truth: a share where it names it among others."""
        names = [(self.cause, self.joints), *self.alternatives]
        if any(_is(truth, names[0]) for truth in truths):
            return self.confidence
        return self.confidence / len(names) if any(_is(t, one) for t in truths for one in names) else 0.0

    @property
    def text(self) -> str:
        """Write it."""
        joints = " ".join(map(str, self.joints))
        others = (
            f" or {', '.join(sorted({one for one, _ in self.alternatives}))}" if self.alternatives else ""
        )
        return f"{self.cause} [{joints}] {self.confidence:.2f}{others} ({self.size})"


Named = tuple[tuple[Name, ...], str, tuple[tuple[str, tuple[int, ...]], ...]]


@dataclass(frozen=True)
class Answer:
    """Hold what a case was answered."""

    names: tuple[Name, ...]
    probability: float
    """On the truth."""
    wrong: tuple[Name, ...]
    """Confident names that are neither right nor given for the unchanged log."""
    verdict: str
    denied: bool
    """Whether the truth is said not to be identifiable."""
    seconds: float


def answer(case: Case) -> Answer:
    """Ask and compare."""
    begun = time.process_time()
    names, verdict, open_causes = named(case.asked)
    usual = {(one.cause, one.joints) for one in sound(case.sound.name, case.sound)[0]}
    wrong = tuple(
        one
        for one in names
        if one.confidence > CONFIDENT
        and not one.share_on(case.truths)
        and (one.cause, one.joints) not in usual
    )
    share = max((one.share_on(case.truths) for one in names), default=0.0)
    if not case.truths:
        share = 1.0 - max(
            (one.confidence for one in names if (one.cause, one.joints) not in usual), default=0.0
        )
    denied = any(_is(truth, one) for truth in case.truths for one in open_causes)
    return Answer(names, share, wrong, verdict, denied, time.process_time() - begun)


@cache
def sound(_name: str, source: Source) -> Named:
    """Ask for the diagnosis of unchanged logs, once."""
    return named(source)


def named(source: Source) -> Named:
    """Give the names and the verdict of a diagnosis, and what it says is not identifiable."""
    options: dict[str, object] = dict(OPTIONS)
    reference = None
    try:
        if source.reference:
            reference = identify(IdentifyRequest(source.robot, source.reference, OPTIONS))
            options["reference"] = "earlier"
        document = diagnose(IdentifyRequest(source.robot, source.logs, options, reference))
    except VeritorqueError as error:
        return (), f"refused: {error}"[:160], ()
    found: Any = document["diagnosis"]
    rows: Any = document["conflicts"]
    conflicts = [_name(row["conflict"], row, row["statement"]) for row in rows]
    causes = [_name(row["cause"], row, _size(row)) for row in found["findings"]]
    closed = tuple(
        (row["cause"], (joint,)) for row in found["not_identifiable"] for joint in row["joints"] or (0,)
    )
    return (*conflicts, *causes), str(found["verdict"]), closed


def _name(cause: str, row: Mapping[str, Any], size: str) -> Name:
    others = tuple(
        (one.get("cause") or one["conflict"], tuple(one["joints"])) for one in row["ambiguous_with"]
    )
    return Name(cause, tuple(row["joints"]), float(row["confidence"]), others, size)


def _size(row: Mapping[str, Any]) -> str:
    return ", ".join(f"{one['name']} {one['value']:.3g}" for one in row["parameters"][:2])


def _is(truth: Truth, given: tuple[str, tuple[int, ...]]) -> bool:
    name, joints = truth
    return name == given[0] and (joints is None or not joints or joints == given[1])
