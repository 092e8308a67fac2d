"""Draw hidden effects afresh, ask for their diagnosis on two processes, and print how it went.

Run ``make hidden SEED=3 CASES=60``, with STRENGTH, CAUSE or KIND (single, combination, clean, foreign) to
look at one thing only, or ``make battery SEED=3`` for the whole examination, which takes hours.
``make ablate`` halves and doubles every threshold of the diagnosis, and lists those that change no answer.
``python -m tests.hidden regressions`` diagnoses the logs that were answered wrongly once, and
``python -m tests.hidden clean --world second`` those of another simulation in which nothing is hidden.
"""

import argparse
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from importlib import import_module
from multiprocessing import get_context

from tests.hidden.plan import KINDS, Order, battery, orders, run
from tests.hidden.score import Score
from tests.hidden.tables import tables
from tests.plant.effects.registry import EFFECTS

COMMANDS = ("ablate", "calibrate", "changed", "clean", "regressions")
"""Modules of this folder with a task of their own, loaded late: one must not have loaded the diagnosis."""


def main() -> int:
    """Run, and print every miss as it comes and the tables at the end."""
    if sys.argv[1:] and sys.argv[1] in COMMANDS:
        command = import_module(f"tests.hidden.{sys.argv[1]}")
        return int(command.main(sys.argv[2:]))
    asked = _arguments()
    begun = time.monotonic()
    listed = _listed(asked)
    scored = []
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        for order, score in pool.map(run, listed):
            if score is None:
                sys.stdout.write(
                    f"{order.kind} seed {order.seed}: {order.cause} cannot be that strong, left out\n"
                )
                continue
            scored.append((order, score))
            _tell(order, score)
    sys.stdout.write("\n".join(tables(scored)) + "\n")
    sys.stdout.write(f"\n{len(scored)} cases in {time.monotonic() - begun:.0f} s\n")
    return 0


def _listed(asked: argparse.Namespace) -> list[Order]:
    if asked.battery:
        return battery(asked.seed)
    return orders(asked.seed, asked.cases, strength=asked.strength, cause=asked.cause, kind=asked.kind)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seed", type=int, default=1, help="decides every case")
    parser.add_argument("--cases", type=int, default=60, help="how many are drawn")
    parser.add_argument("--battery", action="store_true", help="draw the whole examination")
    parser.add_argument("--strength", type=float, help="RMS of the effect over the noise's")
    parser.add_argument("--cause", choices=sorted(EFFECTS), help="hide nothing but this")
    parser.add_argument("--kind", choices=sorted(set(KINDS)), help="draw nothing but this")
    return parser.parse_args()


def _tell(order: Order, score: Score) -> None:
    """Print what went wrong in a case, if anything did."""
    wrong = [f"{one.cause} answered {one.given}" for one in score.answers if not one.named]
    wrong += [f"extra {name}" for name in score.extra]
    if order.kind == "foreign" and not score.unexplained:
        wrong.append("not called unexplained")
    if wrong:
        head = f"{order.kind} seed {order.seed} {score.noise} {order.strength:g}"
        sys.stdout.write(f"{head}: {'; '.join(wrong)}\n")
        sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
