"""Keep drawn cases in the system's temporary folder, so that a diagnosis can be tried on the same ones again.

A case is filed under its arguments and a hash of the plant's source: a changed plant draws anew. One that is
listed in `known.json` is made without a search.
"""

import hashlib
import json
import tempfile
from collections.abc import Callable
from dataclasses import asdict
from functools import cache
from pathlib import Path

import numpy as np

from tests.plant.cases import Case, Truth
from tests.plant.effects.effect import Hidden
from tests.plant.known import known_case
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.writing import to_description

FOLDER = Path(tempfile.gettempdir()) / "veritorque-plant"


def kept(draw: Callable[..., Case], *arguments: object, **options: object) -> Case:
    """Give the case that `draw` makes of the arguments, from the folder if it was drawn before."""
    asked = json.dumps([draw.__name__, arguments, sorted(options.items())])
    path = FOLDER / _source() / f"{hashlib.sha256(asked.encode()).hexdigest()[:24]}.npz"
    if path.exists():
        return _read(path)
    case = known_case(asked) or draw(*arguments, **options)
    path.parent.mkdir(parents=True, exist_ok=True)
    _write(path, case)
    return case


@cache
def _source() -> str:
    files = sorted(one for one in Path(__file__).parent.rglob("*.py") if not one.name.startswith("test_"))
    return hashlib.sha256(b"".join(one.read_bytes() for one in files)).hexdigest()[:16]


def _write(path: Path, case: Case) -> None:
    rows = whole_rows(case.log)
    document = {
        "believed": to_description(case.believed),
        "truth": [asdict(one) for one in case.truth],
        "noise": case.noise,
        "robot": case.robot,
        "seed": case.seed,
    }
    arrays = {
        "time": rows.time,
        "position": rows.position,
        "torque": rows.torque,
        "noise_rms": case.noise_rms,
    }
    if rows.temperature is not None:
        arrays["temperature"] = rows.temperature
    unfinished = path.with_suffix(f".{id(case)}.npz")
    np.savez(unfinished, document=np.array(json.dumps(document)), **arrays)
    unfinished.replace(path)


def _read(path: Path) -> Case:
    with np.load(path) as stored:
        document = json.loads(str(stored["document"]))
        channels = {"temperature": stored["temperature"]} if "temperature" in stored else {}
        log = log_from_arrays("plant", stored["time"], stored["position"], stored["torque"], **channels)
        noise_rms = stored["noise_rms"]
    truth = tuple(
        Truth(
            **one
            | {
                "joints": tuple(one["joints"]),
                "parameters": tuple(Hidden(**number) for number in one["parameters"]),
            }
        )
        for one in document["truth"]
    )
    return Case(
        believed=robot_from_description(document["believed"]),
        log=log,
        truth=truth,
        noise=document["noise"],
        noise_rms=noise_rms,
        robot=document["robot"],
        seed=document["seed"],
    )
