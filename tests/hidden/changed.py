"""Diagnose logs of the second world in which textbook effects are hidden, and count what is named besides.

Run ``python -m tests.hidden changed --seed 3 --cases 20``. It prints every log's truth and findings, and how
often the truth was named and something else was.
"""

import argparse
import sys
from collections import Counter

import numpy as np

from tests.hidden.plan import answered
from tests.hidden.score import Score, rate, score
from tests.plant.cases import Case, Truth
from tests.plant.second import HIGHEST_HZ, draw_changed
from tests.plant.second_effects import Change
from tests.plant.sensors import NOISES

SURE = 0.5
"""A finding above this headlines an answer."""


def main(arguments: list[str]) -> int:
    """Print what is named, log by log, and the rates."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seed", type=int, default=1, help="decides every log")
    parser.add_argument("--cases", type=int, default=4, help="how many logs of each kind of motion")
    asked = parser.parse_args(arguments)
    numbers = range(1000 * asked.seed, 1000 * asked.seed + asked.cases)
    scores = [_told(number, motion) for number in numbers for motion in HIGHEST_HZ]
    answers = [answer for one in scores for answer in one.answers]
    extra = [any(sure > SURE and not right for sure, right in one.confidences) for one in scores]
    sys.stdout.write(f"named          {rate(answer.named for answer in answers)}\n")
    sys.stdout.write(f"nothing extra  {rate(not one.extra for one in scores)}\n")
    sys.stdout.write(f"none above {SURE} {rate(not one for one in extra)}\n")
    missed = Counter((answer.cause, answer.given) for answer in answers if not answer.exact)
    for (cause, given), count in missed.most_common():
        sys.stdout.write(f"{cause} answered by {given}: {count}\n")
    return 0


def _told(seed: int, motion: str) -> Score:
    noise = NOISES[seed % len(NOISES)]
    robot, log, changes = draw_changed(seed, motion, noise)
    answer = answered(Case(robot, log, (), noise, np.zeros(2), "second", seed))
    judged = score(answer, [_truth(one) for one in changes], kind="changed", noise=noise, seed=seed)
    hidden = ", ".join(f"{one.cause} [{one.joint + 1}] {one.size:.2f}" for one in changes)
    words = [
        f"{one['cause']} {one['joints']} at {one['confidence']:.2f}"
        + "".join(f" / {other['cause']}" for other in one["ambiguous_with"])
        for one in answer["findings"]
    ]
    mark = "EXTRA" if judged.extra else "ok" if all(one.named for one in judged.answers) else "missed"
    sys.stdout.write(f"{mark} {motion} {seed} {noise}: {hidden} | {answer['verdict']}; {'; '.join(words)}\n")
    sys.stdout.flush()
    return judged


def _truth(change: Change) -> Truth:
    unknown = float("nan")
    return Truth(change.cause, (change.joint + 1,), (), unknown, unknown, nameable=True, local=change.local)
