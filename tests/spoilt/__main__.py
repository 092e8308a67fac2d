"""Spoil the values of sound logs and print the false causes: ``make spoilt RUNS=400 SEED=2``."""

import argparse
import sys
import time
from collections import defaultdict
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context

from tests.hidden.score import rate
from tests.saying import say
from tests.spoilt.campaign import CONFIDENT, Outcome, outcome
from tests.spoilt.ways import WAYS

LARGEST_SHARE = 0.01
"""Of spoilt logs on which a false cause may be named with confidence."""


def main(arguments: Sequence[str]) -> int:
    """Print what went wrong as it comes, and tables at the end; fail where too much did."""
    parser = argparse.ArgumentParser(prog="python -m tests.spoilt", description="Spoil values and ask.")
    parser.add_argument("--seed", type=int, default=1, help="decides everything that is drawn")
    parser.add_argument("--runs", type=int, default=200, help="how many logs are spoilt")
    parser.add_argument("--first", type=int, default=0, help="number of the first of them")
    parser.add_argument("--ways", nargs="+", choices=list(WAYS), default=(), help="spoil in these ways only")
    asked = parser.parse_args(arguments)
    begun, outcomes = time.monotonic(), []
    ask = partial(outcome, asked.seed, ways=tuple(asked.ways))
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        for one in pool.map(ask, range(asked.first, asked.first + asked.runs)):
            outcomes.append(one)
            _tell(one)
    _tables(outcomes)
    say(f"{len(outcomes)} logs in {time.monotonic() - begun:.0f} s")
    wrong = sum(one.is_wrong for one in outcomes)
    return int(wrong > LARGEST_SHARE * len(outcomes) or any(one.failed for one in outcomes))


def _tell(one: Outcome) -> None:
    said = [f"FAILED {one.failed}"] if one.failed else []
    said += [f"{cause} at {sure:.2f}" for cause, sure in one.false if sure > 0.5]
    if said:
        beside = f" (conflicts {', '.join(one.conflicts)})" if one.conflicts else ""
        say(f"{one.number} {one.log}, {' + '.join(one.ways)}: {'; '.join(said)}{beside}")


def _tables(outcomes: Sequence[Outcome]) -> None:
    by_way: dict[str, list[Outcome]] = defaultdict(list)
    for one in outcomes:
        for way in one.ways:
            by_way[way].append(one)
    say(f"\n{'spoilt by':20} {'logs':>5} {'refused':>8} {'conflict':>9} {'false':>6} {'confident':>10}")
    for way in WAYS:
        mine = by_way[way]
        counts = (
            len(mine), sum(bool(one.refused) for one in mine), sum(bool(one.conflicts) for one in mine),
            sum(bool(one.false) for one in mine), sum(one.is_wrong for one in mine),
        )  # fmt: skip  # a table
        say(f"{way:20} {counts[0]:5} {counts[1]:8} {counts[2]:9} {counts[3]:6} {counts[4]:10}")
    refusals: dict[str, int] = defaultdict(int)
    for one in outcomes:
        refusals[one.refused.partition("\n")[0][:100]] += bool(one.refused)
    for text, times in sorted(refusals.items(), key=lambda pair: -pair[1]):
        if times:
            say(f"{times:5} refused: {text}")
    say(f"a false cause above {CONFIDENT:g}: {rate(one.is_wrong for one in outcomes)}")
    say(f"errors of no type of ours: {rate(bool(one.failed) for one in outcomes)}")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
