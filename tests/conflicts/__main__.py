"""Spoil measured and simulated robots and logs, and print what is named: ``python -m tests.conflicts``.

Measured logs are taken where they lie beside the project.
"""

import argparse
import sys
from collections import defaultdict
from collections.abc import Iterator, Sequence

import numpy as np

from tests.conflicts.score import Answer, answer, matters, mean_percent
from tests.conflicts.spoil import SPOILERS
from tests.measured import measured_log, measured_robot
from tests.plant.cases import draw_clean
from tests.saying import say
from tests.tools import SHARED
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import read_log
from veritorque.core.robot.model import RobotModel
from veritorque.core.robot.urdf.read import robot_from_urdf
from veritorque.core.study import IdentifyRequest, identify

RUNS = {
    "ur10e_open": ("fourier_30s_12h", 0, None),
    "staubli_tx40": ("run1", 500, 37_000),
    "franka_panda": ("traj1", 0, None),
    "rokae_xmate3": ("excit", 0, None),
}


def main(arguments: Sequence[str]) -> int:
    """Spoil every robot in every way so many times, and print the table."""
    parser = argparse.ArgumentParser(prog="python -m tests.conflicts", description="Spoil and ask.")
    parser.add_argument("--seed", type=int, default=1, help="decides everything that is drawn")
    parser.add_argument("--each", type=int, default=2, help="how often each way is drawn on each robot")
    parser.add_argument("--robots", nargs="*", help="some of the robots")
    asked = parser.parse_args(arguments)
    totals: dict[str, list[tuple[Answer, bool]]] = defaultdict(list)
    for name, robot, log in robots(asked.seed):
        if asked.robots and name not in asked.robots:
            continue
        sound = mean_percent(identify(IdentifyRequest(robot, (log,), {"bootstrap": {"draws": 0}})))
        for way, spoiler in SPOILERS.items():
            for number in range(1 if way == "nothing" else asked.each):
                rng = np.random.default_rng([asked.seed, number, len(way), len(name)])
                spoilt = spoiler(robot, log, rng)
                found = answer(spoilt)
                changes = bool(found.failed) or matters(spoilt, sound)
                totals[way].append((found, changes))
                mark = "ok " if found.exact else ("-- " if changes else "   ")
                hidden = f"{way} {list(spoilt.joints)} {spoilt.channel}"
                say(
                    f"{mark}{name:13} {hidden:38} {found.seconds:5.1f} s  "
                    f"{'; '.join(found.named)}{found.failed}"
                )
    _table(totals)
    return 0


def robots(seed: int) -> Iterator[tuple[str, RobotModel, JointLog]]:
    """Give sound robots with a log each."""
    for name, run in RUNS.items():
        if (SHARED / "data" / name).exists():
            yield name, measured_robot(name), measured_log(name, *run)
    case = SHARED / "cases" / "logs"
    if case.exists():
        yield "arm3", robot_from_urdf((case / "arm3.urdf").read_bytes()), read_log(case / "arm3_clean.csv")
    for name in ("yumi-left", "planar-3", "ur10e"):
        drawn = draw_clean(10_000 + seed, noise="white", robot=name)
        yield name, drawn.believed, drawn.log


def _table(totals: dict[str, list[tuple[Answer, bool]]]) -> None:
    say(f"\n{'spoilt':20} {'drawn':>6} {'matter':>7} {'named':>6} {'share':>7}")
    matter = named = 0
    for way, answers in totals.items():
        counted = [one for one, changes in answers if changes or way == "nothing"]
        right = sum(one.exact for one in counted)
        share = f"{100.0 * right / len(counted):6.0f}%" if counted else ""
        say(f"{way:20} {len(answers):6} {len(counted):7} {right:6} {share}")
        if way != "nothing":
            matter, named = matter + len(counted), named + right
    say(f"{'all that was spoilt':20} {'':6} {matter:7} {named:6} {100.0 * named / max(matter, 1):6.0f}%")
    silent = [
        one for way, answers in totals.items() for one, changes in answers if not changes and way != "nothing"
    ]
    wrong = sum(bool(one.named) and not one.exact for one in silent)
    say(f"of {len(silent)} that change the error by less than a fifth, {wrong} are named wrongly")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
