"""Diagnose clean logs of the second world, in which the encoder's error is in the loop and in the log.

Run ``python -m tests.hidden clean --world second``. It prints what is named
on every log and a table. What an error of a position does to torque and columns alike can pass for a spring.
"""

import argparse
import sys
from collections import Counter

import numpy as np

from tests.hidden.plan import answered
from tests.plant.cases import Case
from tests.plant.second import HIGHEST_HZ, NOISE_SHARE, draw_second


def main(arguments: list[str]) -> int:
    """Print what is named, log by log, and how often each cause is; fail where anything is."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--world", choices=["second"], default="second", help="the simulation")
    parser.add_argument("--seed", type=int, default=1, help="decides every log")
    parser.add_argument("--cases", type=int, default=4, help="how many logs of each kind of motion")
    parser.add_argument("--noise", type=float, default=NOISE_SHARE, help="torque noise over torque, RMS")
    parser.add_argument("--finer", type=float, default=1.0, help="how much finer than usual the encoder is")
    asked = parser.parse_args(arguments)
    named: Counter[tuple[str, str]] = Counter()
    for motion in HIGHEST_HZ:
        for seed in range(100 * asked.seed, 100 * asked.seed + asked.cases):
            robot, log = draw_second(seed, motion, noise=asked.noise, finer=asked.finer)
            findings = answered(Case(robot, log, (), "white", np.zeros(2), "second", seed))["findings"]
            named.update((motion, one["cause"]) for one in findings)
            words = [f"{one['cause']} {one['joints']} at {one['confidence']:.2f}" for one in findings]
            sys.stdout.write(f"{motion} {seed}: {'; '.join(words) or 'nothing'}\n")
            sys.stdout.flush()
    for (motion, cause), count in sorted(named.items()):
        sys.stdout.write(f"{cause} on {count} of {asked.cases} logs of {motion} motion\n")
    return int(bool(named))
