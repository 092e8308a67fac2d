"""Diagnose clean logs of the second world, in which the encoder's error is in the loop and in the log.

Run ``python -m tests.hidden clean --world second``. It prints what is named on every log and a table.
What an error of a position does to torque and columns alike can pass for a spring.
"""

import argparse
import sys
from collections import Counter

import numpy as np

from tests.hidden.plan import answered
from tests.plant.cases import Case
from tests.plant.second import HIGHEST_HZ, draw_second
from tests.plant.sensors import NOISES


def main(arguments: list[str]) -> int:
    """Print what is named, log by log, and how often each cause is; fail where anything is."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--world", choices=["second"], default="second", help="the simulation")
    parser.add_argument("--seed", type=int, default=1, help="decides every log")
    parser.add_argument("--cases", type=int, default=4, help="how many logs of each kind of motion")
    parser.add_argument("--finer", type=float, default=1.0, help="how much finer than usual the encoder is")
    asked = parser.parse_args(arguments)
    named: Counter[tuple[str, str]] = Counter()
    for motion in HIGHEST_HZ:
        for seed in range(100 * asked.seed, 100 * asked.seed + asked.cases):
            noise = NOISES[seed % len(NOISES)]
            robot, log = draw_second(seed, motion, noise, finer=asked.finer)
            answer = answered(Case(robot, log, (), noise, np.zeros(2), "second", seed))
            causes = [one["cause"] for one in answer["findings"]]
            named.update((motion, cause) for cause in {*causes, answer["verdict"]})
            words = [
                f"{one['cause']} {one['joints']} at {one['confidence']:.2f}" for one in answer["findings"]
            ]
            sys.stdout.write(f"{motion} {seed} {noise}: {answer['verdict']}; {'; '.join(words)}\n")
            sys.stdout.flush()
    for (motion, said), count in sorted(named.items()):
        sys.stdout.write(f"{said} on {count} of {asked.cases} logs of {motion} motion\n")
    return int(any(said != "nothing_found" for _, said in named))
