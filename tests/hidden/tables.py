"""Write what a run of hidden cases showed as tables for a terminal."""

from collections.abc import Callable, Iterator

import numpy as np

from tests.hidden.plan import Order
from tests.hidden.score import Answer, Rate, Score, brier, confusion, rate, reliability

ScoredCandidate = list[tuple[Order, Score]]


def tables(scored: ScoredCandidate) -> Iterator[str]:
    """Give the lines: per strength, per cause, combinations, clean, foreign, sizes, confidence, confusion."""
    yield from _by("strength", scored, lambda order, _: f"{order.strength:g}")
    usual = [one for one in scored if one[0].strength == 1.0] or scored
    yield from _by("cause at strength 1", usual, lambda _, answer: answer.cause)
    yield from _cases(scored)
    yield from _confidence([score for _, score in scored])
    yield from _confusion([score for _, score in scored])


def _by(title: str, scored: ScoredCandidate, key: Callable[[Order, Answer], str]) -> Iterator[str]:
    groups: dict[str, list[Answer]] = {}
    for order, score in scored:
        for answer in score.answers if order.kind == "single" else ():
            groups.setdefault(key(order, answer), []).append(answer)
    yield ""
    heads = ("named", "exact", "named of the nameable", "sizes inside 95 %")
    yield f"single effects by {title:19s}" + "".join(f"{head:27s}" for head in heads)
    for name, answers in sorted(groups.items()):
        cells = (
            rate(one.named for one in answers),
            rate(one.exact for one in answers),
            rate(one.named for one in answers if one.nameable),
            rate(inside for one in answers for inside in one.sizes),
        )
        yield f"  {name:35s}" + "".join(f"{cell!s:27s}" for cell in cells)


def _cases(scored: ScoredCandidate) -> Iterator[str]:
    def of(kind: str) -> list[Score]:
        return [score for order, score in scored if order.kind == kind]

    together, clean, foreign = of("combination"), of("clean"), of("foreign")
    yield ""
    lines: dict[str, Rate] = {
        "single: nothing extra": rate(not one.extra for one in of("single")),
        "combinations: all named": rate(all(a.named for a in one.answers) for one in together),
        "combinations: nothing extra": rate(not one.extra for one in together),
        "clean: a false cause": rate(bool(one.extra) for one in clean),
        "foreign: unexplained or a class": rate(one.unexplained for one in foreign),
        "foreign: confidently wrong": rate(one.confidently_wrong for one in foreign),
    }
    for noise in sorted({one.noise for one in clean}):
        lines[f"clean, {noise}: a false cause"] = rate(bool(one.extra) for one in clean if one.noise == noise)
    for name, cell in lines.items():
        yield f"{name:37s}{cell}"


def _confidence(scores: list[Score]) -> Iterator[str]:
    yield ""
    yield f"{'Brier score':37s}{brier(scores):.4f}"
    median, most, worst = np.quantile([one.seconds for one in scores], [0.5, 0.95, 1.0])
    yield f"{'CPU time per log, s':37s}{median:.1f} median, {most:.1f} in 95 %, {worst:.1f} at most"
    yield f"{'confidence':37s}{'mean':10s}right"
    for low, high, mean, right in reliability(scores):
        yield f"  {f'{low:g} to {high:g}':35s}{mean:<10.3f}{right}"


def _confusion(scores: list[Score]) -> Iterator[str]:
    counts = confusion(scores)
    yield ""
    yield "hidden -> answered (right answers left out)"
    for (hidden, given), count in sorted(counts.items()):
        silence = {"clean": "nothing_found", "foreign": "unexplained"}
        if given != silence.get(hidden, hidden):
            yield f"  {hidden:35s}{given:35s}{count:4d}"
