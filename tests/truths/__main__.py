"""Change one thing in measured logs, and print what is named: ``python -m tests.truths``.

``make truths SEED=n ONLY=text`` runs the cases whose robot or name holds the text. The logs lie beside the
project; without them nothing is run, and that is said.
"""

import argparse
import sys
from collections.abc import Sequence

from tests.saying import say
from tests.tools import SHARED
from tests.truths.cases import cases, sources
from tests.truths.score import CONFIDENT, NAMED, answer, sound


def main(arguments: Sequence[str]) -> int:
    """Ask for every case and print a line each, then the figures."""
    parser = argparse.ArgumentParser(prog="python -m tests.truths", description="Change and ask.")
    parser.add_argument("--seed", type=int, default=1, help="decides all sizes")
    parser.add_argument("--only", default="", help="a part of the name of a robot or case")
    parser.add_argument("--sound", action="store_true", help="diagnose the unchanged logs alone")
    asked = parser.parse_args(arguments)
    if not (SHARED / "data").exists():
        say(f"SKIPPED FOR WANT OF DATA: {SHARED / 'data'} is not there")
        return 0
    if not asked.sound:
        _ask_all(asked.seed, asked.only)
        return 0
    for name, source in sources().items():
        if asked.only in name:
            say(f"{name}: {'; '.join(one.text for one in sound(name, source)[0]) or 'nothing'}")
    return 0


def _ask_all(seed: int, only: str) -> None:
    answers = []
    for case in cases(seed):
        if only not in f"{case.asked.name}: {case.name}":
            continue
        found = answer(case)
        answers.append(found)
        mark = "ok " if found.probability >= NAMED else "   "
        denied = "NOT IDENTIFIABLE, it says " if found.denied else ""
        wrong = f"  WRONG {len(found.wrong)}" if found.wrong else ""
        names = "; ".join(one.text for one in found.names) or "nothing"
        head = f"{mark}{found.probability:.2f} {case.asked.name}: {case.name}{wrong}"
        say(f"{head} | {denied}{found.verdict} {found.seconds:.0f} s | {names}")
    if answers:
        mean = sum(one.probability for one in answers) / len(answers)
        say(f"\nnamed {sum(one.probability >= NAMED for one in answers)} of {len(answers)}")
        say(f"mean probability on the truth {mean:.2f}")
        say(f"wrong names above {CONFIDENT:g}: {sum(len(one.wrong) for one in answers)}")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
