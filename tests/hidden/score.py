"""Score answers against what was hidden: named, exact, missed, extra, size, confidence, with intervals.

A cause is named when a finding gives it on its joint, by its own name or among the alternatives that it
says it cannot distinguish; it is exact when it is the finding's own name and joint. Sources: Clopper &
Pearson, Biometrika 26 (1934), for the intervals; Brier, Monthly Weather Review 78 (1950), for the confidence.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.stats import binomtest

from tests.plant.cases import Truth

NOTHING, UNEXPLAINED = "nothing_found", "unexplained"
CONFIDENT = 0.9
DEVIATIONS = 1.96
Finding = Mapping[str, Any]


@dataclass(frozen=True)
class Answer:
    """Say how one hidden cause was answered.

    Attributes
    ----------
    given
        What was answered in its place: its own name, another finding's, or the verdict.
    sizes
        For every hidden number that the finding gives: whether it lies in the 95 % interval.
    """

    cause: str
    given: str
    strength: float
    nameable: bool
    named: bool
    exact: bool
    sizes: tuple[bool, ...]


@dataclass(frozen=True)
class Score:
    """Say how one case was answered.

    `extra` are the findings that nothing hidden accounts for; `confidences` pairs every finding's confidence
    with whether it was right. For a foreign effect `unexplained` says that it was called so or that only
    alternatives were named, and `confidently_wrong` that a single name was given with confidence. `seconds`
    is the CPU time that the answer took.
    """

    kind: str
    noise: str
    seed: int
    answers: tuple[Answer, ...]
    extra: tuple[str, ...]
    confidences: tuple[tuple[float, bool], ...]
    unexplained: bool
    confidently_wrong: bool
    seconds: float = float("nan")


def score(diagnosis: Mapping[str, Any], truth: Sequence[Truth], *, kind: str, noise: str, seed: int) -> Score:
    """Compare one diagnosis (the document's object of this name) with what was hidden.

    A foreign effect is given as no truth at all: every finding is then extra.
    """
    findings: list[Finding] = list(diagnosis["findings"])
    hidden = () if kind == "foreign" else tuple(truth)
    alone = [finding for finding in findings if not finding["ambiguous_with"]]
    return Score(
        kind=kind,
        noise=noise,
        seed=seed,
        answers=tuple(_answer(one, findings, hidden, str(diagnosis["verdict"])) for one in hidden),
        extra=tuple(str(one["cause"]) for one in findings if not any(_names(one, cause) for cause in hidden)),
        confidences=tuple(
            (float(one["confidence"]), any(_names(one, cause) for cause in hidden)) for one in findings
        ),
        unexplained=diagnosis["verdict"] == UNEXPLAINED or (bool(findings) and not alone),
        confidently_wrong=any(float(one["confidence"]) >= CONFIDENT for one in alone),
    )


def _answer(truth: Truth, findings: list[Finding], hidden: tuple[Truth, ...], verdict: str) -> Answer:
    naming = sorted((one for one in findings if _names(one, truth)), key=lambda one: not _is(one, truth))
    spare = [one for one in findings if not any(_names(one, other) for other in hidden)]
    here = [one for one in spare if set(one["joints"]) & set(truth.joints)] or spare
    exact = bool(naming) and _is(naming[0], truth)
    instead = max(here, key=lambda one: float(one["confidence"]))["cause"] if here else verdict
    return Answer(
        cause=truth.cause,
        given=str(naming[0]["cause"] if naming else instead),
        strength=truth.strength,
        nameable=truth.nameable,
        named=bool(naming),
        exact=exact,
        sizes=_sizes(truth, naming[0]) if exact else (),
    )


def _names(finding: Finding, truth: Truth) -> bool:
    """Tell whether a finding gives this cause, or lists it as one that it cannot distinguish."""
    return any(_is(one, truth) for one in (finding, *finding["ambiguous_with"]))


def _is(given: Finding, truth: Truth) -> bool:
    """Tell whether a finding or a alternative is of this cause and, where the cause is of joints, on them."""
    in_place = not truth.local or bool(set(given["joints"]) & set(truth.joints))
    return given["cause"] == truth.cause and in_place


def _sizes(truth: Truth, finding: Finding) -> tuple[bool, ...]:
    found = {one["name"]: one for one in finding["parameters"] if one["joint"] in (None, *truth.joints)}
    known = {hidden.name: hidden.value for hidden in truth.parameters}
    inside = []
    for hidden in truth.parameters:
        one = found.get(_same_span(hidden.name, known, found))
        if one is None or not one.get("standard_deviation"):
            continue
        off = float(one["value"]) - hidden.value
        if hidden.name == "phase":
            off = (off + np.pi) % (2.0 * np.pi) - np.pi
        inside.append(bool(abs(off) <= DEVIATIONS * float(one["standard_deviation"])))
    return tuple(inside)


def _same_span(name: str, known: Mapping[str, float], found: Mapping[str, Finding]) -> str:
    """Name the end of the span found that overlaps a hidden one most: who finds two of three numbers anew."""
    end, _, number = name.partition("_")
    if not number.isdigit():
        return name

    def overlap(other: str) -> float:
        low, high = (float(found[f"{side}_{other}"]["value"]) for side in ("start", "end"))
        return min(high, known[f"end_{number}"]) - max(low, known[f"start_{number}"])

    spans = [one.partition("_")[2] for one in found if one.startswith("start_")]
    best = max(spans, key=overlap, default=number)
    return f"{end}_{best}" if spans and overlap(best) > 0.0 else ""


@dataclass(frozen=True)
class Rate:
    """Hold a share with its 95 % interval by Clopper and Pearson."""

    hits: int
    trials: int

    @property
    def share(self) -> float:
        """Give the share, nan of nothing."""
        return self.hits / self.trials if self.trials else float("nan")

    @property
    def interval(self) -> tuple[float, float]:
        """Give the interval, everything of nothing."""
        if not self.trials:
            return 0.0, 1.0
        low, high = binomtest(self.hits, self.trials).proportion_ci(0.95, method="exact")
        return float(low), float(high)

    def __str__(self) -> str:
        """Write share and interval in percent.

        Examples
        --------
        >>> str(Rate(9, 10))
        '  9/10      90 % [55.5, 99.7]'
        """
        if not self.trials:
            return "  0/0      -"
        low, high = (100.0 * end for end in self.interval)
        return f"{self.hits:3d}/{self.trials:<4d} {100.0 * self.share:5.3g} % [{low:.1f}, {high:.1f}]"


def rate(flags: Iterable[bool]) -> Rate:
    """Count what is so among what was tried."""
    tried = [bool(flag) for flag in flags]
    return Rate(sum(tried), len(tried))


def confusion(scores: Iterable[Score]) -> dict[tuple[str, str], int]:
    """Count (hidden cause, answer) pairs; clean and foreign cases go by their kind."""
    counts: dict[tuple[str, str], int] = {}
    for one in scores:
        pairs = [(answer.cause, answer.given) for answer in one.answers]
        if not one.answers:
            verdict = UNEXPLAINED if one.unexplained else NOTHING
            pairs = [(one.kind, one.extra[0] if one.extra else verdict)]
        for pair in pairs:
            counts[pair] = counts.get(pair, 0) + 1
    return counts


def brier(scores: Iterable[Score]) -> float:
    """Give the mean squared difference of confidence and being right, over all findings; nan of none."""
    squares = [(sure - right) ** 2 for one in scores for sure, right in one.confidences]
    return float(np.mean(squares)) if squares else float("nan")


def reliability(
    scores: Iterable[Score], edges: Sequence[float] = (0.0, 0.5, 0.8, 0.9, 0.97, 1.0)
) -> list[tuple[float, float, float, Rate]]:
    """Give for every bin of confidence its edges, the mean confidence in it and the rate of being right."""
    pairs = [pair for one in scores for pair in one.confidences]
    table = []
    for low, high in pairwise(edges):
        inside = [(sure, right) for sure, right in pairs if low < sure <= high or (low == 0.0 == sure)]
        mean = float(np.mean([sure for sure, _ in inside])) if inside else float("nan")
        table.append((low, high, mean, rate(right for _, right in inside)))
    return table
