"""Ask for an identification of what was spoilt, and compare what it names with what was done."""

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from tests.conflicts.spoil import Spoilt
from veritorque.core.errors import VeritorqueError
from veritorque.core.study import IdentifyRequest, identify

DIRECTION = np.radians(5.0)
"""Angle, rad, up to which a direction of gravity is the hidden one."""
MATTERS = 1.2
"""Factor on the error on held-out data from which a spoilt thing has to be named."""
PLAIN: dict[str, Any] = {"bootstrap": {"draws": 0}}


@dataclass(frozen=True)
class Answer:
    """Hold what was named, and how right it is."""

    named: tuple[str, ...]
    """Conflicts with joints and channel, as text."""
    exact: bool
    """Whether the hidden conflict is the only one named, or declared not to be distinguished from it."""
    seconds: float
    """Processor time of the whole identification, s."""
    failed: str = ""


def answer(spoilt: Spoilt) -> Answer:
    """Identify and compare."""
    begun = time.process_time()
    try:
        document: Mapping[str, Any] = identify(IdentifyRequest(spoilt.robot, (spoilt.log,), PLAIN))
    except VeritorqueError as error:
        return Answer((), exact=False, seconds=0.0, failed=str(error)[:200])
    rows = document["conflicts"]
    named = tuple(f"{row['conflict']} {row['joints']} {row['channel']}" for row in rows)
    exact = len(rows) == 1 and _is_hidden(rows[0], spoilt) if spoilt.conflict else not rows
    return Answer(named, exact, time.process_time() - begun)


def matters(spoilt: Spoilt, sound_percent: float) -> bool:
    """Tell whether it changes the error on held-out data, which was so large before, by a fifth."""
    try:
        as_is = identify(IdentifyRequest(spoilt.robot, (spoilt.log,), PLAIN | {"conflicts": "report"}))
    except VeritorqueError:
        return True
    return mean_percent(as_is) > MATTERS * sound_percent or spoilt.conflict == "time_base"


def mean_percent(document: Mapping[str, Any]) -> float:
    """Give the geometric mean of the joints' errors on held-out data, per cent of their RMS torque."""
    errors = [max(row["nrmse_of_rms_percent"] or 0.0, 1e-3) for row in document["validation"]]
    return float(np.exp(np.mean(np.log(errors))))


def _is_hidden(row: Mapping[str, Any], spoilt: Spoilt) -> bool:
    wanted = (spoilt.conflict, list(spoilt.joints), spoilt.channel)
    same = [
        (other["conflict"], list(other["joints"]), other["channel"])
        for other in (row, *row["ambiguous_with"])
    ]
    if spoilt.gravity is None or row["conflict"] != "mounting":
        return wanted in same or (spoilt.gravity is not None and "mounting" in [one[0] for one in same])
    found = np.array(row["correction"]["robot"]["gravity"])
    cosine = found @ spoilt.gravity / (np.linalg.norm(found) * np.linalg.norm(spoilt.gravity))
    return bool(np.arccos(np.clip(cosine, -1.0, 1.0)) < DIRECTION)
