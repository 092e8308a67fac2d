"""Spoil one sound log in one to three ways, ask for its diagnosis, and say how that ended."""

import tempfile
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from tests.plant.cache import kept
from tests.plant.cases import draw_clean
from tests.plant.second import HIGHEST_HZ, draw_second
from tests.plant.sensors import NOISES
from tests.spoilt.ways import WAYS, Table
from veritorque.core.errors import VeritorqueError
from veritorque.core.log.model import JointLog, whole_rows
from veritorque.core.robot.model import RobotModel

CONFIDENT = 0.8
SOUND = 12
"""So many sound logs are drawn; each is spoilt again and again."""
SECONDS = 15.0
MOST_WAYS = 3


@dataclass(frozen=True)
class Outcome:
    """Say how one spoilt log was answered.

    `false` are the causes named beyond those that a way is, with their confidence; `failed` an error that is
    not the project's own.
    """

    number: int
    log: str
    ways: tuple[str, ...]
    refused: str
    conflicts: tuple[str, ...]
    findings: tuple[tuple[str, float], ...]
    false: tuple[tuple[str, float], ...]
    failed: str

    @property
    def is_wrong(self) -> bool:
        """Tell whether a false cause was named with confidence."""
        return any(sure > CONFIDENT for _, sure in self.false)


def outcome(seed: int, number: int, ways: tuple[str, ...] = ()) -> Outcome:
    """Spoil and ask; the ways are drawn unless given."""
    from veritorque.core.log.reader import read_log
    from veritorque.core.study import IdentifyRequest, diagnose

    rng = np.random.default_rng([seed, number])
    robot, log, name = _sound(seed, number % SOUND)
    chosen = ways or tuple(
        str(way) for way in rng.choice(list(WAYS), int(rng.integers(1, MOST_WAYS + 1)), replace=False)
    )
    table = Table.of(whole_rows(log))
    for way in chosen:
        table = WAYS[way](table, rng)
    refused = failed = ""
    document: Mapping[str, Any] = {}
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = Path(folder) / "spoilt.csv"
        path.write_text(table.csv())
        try:
            read = read_log(path, mapping=table.mapping())
            document = diagnose(IdentifyRequest(robot, (read,), {"bootstrap": {"draws": 0}}))
        except VeritorqueError as error:
            refused = str(error)
        except Exception as error:  # noqa: BLE001 - what is looked for
            failed = f"{type(error).__name__}: {error}"
    found = document.get("diagnosis", {}).get("findings", ())
    named = tuple((str(one["cause"]), float(one["confidence"])) for one in found)
    conflicts = tuple(str(one["conflict"]) for one in document.get("conflicts", ()))
    false = tuple(one for one in named if one[0] not in table.told)
    return Outcome(number, name, chosen, refused, conflicts, named, false, failed)


@cache
def _sound(seed: int, which: int) -> tuple[RobotModel, JointLog, str]:
    """Draw a sound log: of the plant's arms, or of the second world."""
    own = 1000 * seed + which
    noise = NOISES[which % len(NOISES)]
    if which % 3 == 2:
        motion = list(HIGHEST_HZ)[which % 2]
        robot, log = draw_second(own, motion, noise)
        return robot, log, f"second world, {motion}"
    arm = ("planar-2", "planar-3", "ur10e")[which % 9 // 3]
    case = kept(draw_clean, own, noise=noise, robot=arm, duration=SECONDS)
    return case.believed, case.log, arm
