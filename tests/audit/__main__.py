"""Spoil described bodies of drawn arms, and count what an audit names: ``python -m tests.audit --seed 1``."""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass

from tests.audit.draw import Drawn, draw
from veritorque.core.audit.contradictions import contradictions, correct, evidence_of
from veritorque.core.audit.entries import Entry
from veritorque.core.study import IdentifyRequest, identify_in_full

PLAIN = {"bootstrap": {"draws": 0}}


@dataclass(frozen=True)
class Count:
    """Hold the entries of one case: those that the log shows, those named, and those named wrongly."""

    shown: frozenset[Entry]
    named: frozenset[Entry]
    wrong: frozenset[Entry]


def counted(case: Drawn) -> Count:
    """Audit a case; an entry is shown if correcting it alone, all others right, gains what it has to."""
    found = identify_in_full(IdentifyRequest(case.robot, (case.log,), PLAIN))
    evidence = evidence_of(found)
    rest = correct(evidence, case.spoilt).misfit
    shown = frozenset(
        entry
        for entry in case.spoilt
        if correct(evidence, case.spoilt - {entry}).misfit - rest > evidence.price(entry)
    )
    named = frozenset(one.entry for one in contradictions(evidence)[0])
    return Count(shown, named & shown, named - case.spoilt)


def main(arguments: Sequence[str]) -> int:
    """Draw cases and print the count."""
    parser = argparse.ArgumentParser(prog="python -m tests.audit", description="Spoil bodies and ask.")
    parser.add_argument("--seed", type=int, default=1, help="decides everything that is drawn")
    parser.add_argument("--cases", type=int, default=60, help="how many arms are drawn")
    asked = parser.parse_args(arguments)
    counts = [counted(draw(1000 * asked.seed + number)) for number in range(asked.cases)]
    shown, named, wrong = (
        sum(len(getattr(one, what)) for one in counts) for what in ("shown", "named", "wrong")
    )
    sys.stdout.write(f"{asked.cases} arms: {named} of {shown} visible errors named, {wrong} named wrongly\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
