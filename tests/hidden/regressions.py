"""Diagnose every log that was answered wrongly once, and fail where one is so again.

Run ``python -m tests.hidden regressions``; `make hidden` does, too. `make test` has the cheapest of each kind
of mistake (`QUICK`); the others cost ten to thirty seconds each. A measured Rokae comes last.
"""

import argparse
import sys
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import get_context

from tests.hidden.plan import Order, answered, drawn
from tests.hidden.real import examine_rokae
from tests.hidden.score import Score, score


@dataclass(frozen=True)
class Regression:
    """Remember a log that was answered wrongly once."""

    why: str
    """What made its answer wrong."""
    order: Order
    exact: bool = False
    """Whether the cause has to be the finding's own name, and not one of its alternatives'."""
    swaps: bool = False
    """Whether the search has to swap causes, each there and back at most."""
    alone: bool = True
    """Whether nothing else may be named."""


def _single(why: str, seed: int, cause: str, strength: float = 1.0) -> Regression:
    return Regression(why, Order("single", seed, cause, strength), exact=True)


def _several(why: str, seed: int, effects: int) -> Regression:
    return Regression(why, Order("combination", seed, effects=effects))


QUICK = (
    _single("no larger than what slow noise does by itself", 13100057, "external_contact"),
    _single("the noise of positions looks like a filter", 15700714, "timestamp_jitter", 0.3),
    _single(
        "hardly more than a narrow peak of the likelihood over its instant", 15700605, "payload_change", 3.0
    ),
    _several("a fit leaves five times the noise to the noise", 10100775, 3),
    _several("one is ten degrees large", 10100782, 2),
    _several("the torque of two comes late with all the rest", 13900765, 3),
    _several("positions so coarse that a delay may be a filter", 19700763, 3),
)
"""Those that `make test` diagnoses."""
FURTHER = (
    _several("what a wrong angle leaves looks like a wrong length", 22300790, 2),
    _single("what it leaves of a jerk looks like pushes", 15700597, "torque_filter_lag", 3.0),
    _single("the base parameters take up most of it", 13100191, "torque_filter_lag"),
    _single("on a joint whose rotor no fit tells from its link", 13100240, "backlash"),
    _single("the likelihood of its instant has a narrow peak", 15700199, "payload_change"),
    _single("what it leaves of friction looks like Stribeck's", 22300597, "torque_filter_lag", 3.0),
    _several("beside mains hum, and both on one joint", 10100780, 2),
    _several("columns that run nearly parallel", 8900759, 3),
    _several("on joints that follow each other", 8900766, 2),
    _several("a spring beside a joint whose gear does not carry it", 15100784, 2),
    _several("a body joins at an instant beside a held-out block", 13900781, 3),
    _several("half way the noise is left what is not found yet", 17300770, 2),
    _several("friction like Stribeck's that a delay does not leave", 21100775, 3),
    Regression(
        "two that look better than each other",
        Order("combination", 16700779, effects=3),
        exact=True,
        swaps=True,
        alone=False,
    ),
    Regression(
        "pushes are not what a far weaker cause leaves",
        Order("single", 15700666, "external_contact", 3.0),
        exact=True,
        alone=False,
    ),
)


def examine(regression: Regression) -> tuple[Score, list[str]]:
    """Diagnose a log; give the score and what is wrong: causes not named, others named, repeated swaps."""
    order = regression.order
    case = drawn(order)
    begun = time.process_time()
    answer = answered(case)
    seconds = time.process_time() - begun
    found = score(answer, case.truth, kind=order.kind, noise=case.noise, seed=order.seed)
    right = [one.exact if regression.exact else one.named for one in found.answers]
    missed = [one for one, good in zip(found.answers, right, strict=True) if not good]
    mistakes = [f"{one.cause} answered {one.given}" for one in missed]
    mistakes += [f"extra {name}" for name in found.extra if regression.alone]
    swapped = [(one["cause"], *one["joints"]) for one in answer["search"] if one["action"] == "swapped"]
    if regression.swaps and not 0 < len(swapped) == len(set(swapped)):
        mistakes.append(f"swaps {swapped}")
    return replace(found, seconds=seconds), mistakes


def main(arguments: Sequence[str]) -> int:
    """Diagnose them all on two processes, print the figures of each, and count the wrong ones."""
    argparse.ArgumentParser(prog="python -m tests.hidden regressions").parse_args(arguments)
    begun, failed = time.monotonic(), 0
    listed = (*QUICK, *FURTHER)
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        for regression, (found, mistakes) in zip(listed, pool.map(examine, listed), strict=True):
            failed += bool(mistakes)
            _print(regression, found, mistakes)
        said, good = pool.submit(examine_rokae).result()
    failed += not good
    sys.stdout.write(f"{said}\n{failed} of {len(listed) + 1} wrong, in {time.monotonic() - begun:.0f} s\n")
    return int(failed > 0)


def _print(regression: Regression, found: Score, mistakes: list[str]) -> None:
    """Print the strengths of what is hidden, the confidences of what is found, and what is wrong."""
    hidden = ", ".join(f"{one.cause} {one.strength:.2f}" for one in found.answers)
    sure = " ".join(f"{share:.2f}" for share, _ in found.confidences)
    head = f"{regression.order.seed} {found.noise} {hidden}; confidence {sure}; {found.seconds:.1f} s"
    sys.stdout.write(f"{head}: {'; '.join(mistakes) or 'right'}\n")
    sys.stdout.flush()
