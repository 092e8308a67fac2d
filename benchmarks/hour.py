"""An hour of seven joints at 250 Hz, from a Parquet file to the semidefinite programme's result.

Each length is run in a fresh process, imports included; a quarter, one and two hours show that memory does
not grow with the log.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv as arrow_csv
import pyarrow.parquet as pq

from benchmarks.figures import Figure
from benchmarks.scene import NOISE_SHARE, RATE_HZ, smooth_motion, yumi_arm

HOUR = 900_000
PIECE = 50_000


def run(*, quick: bool) -> list[Figure]:
    """Write each log, run it, and read processor time and peak memory."""
    hour = HOUR // 30 if quick else HOUR
    figures: list[Figure] = []
    peaks: list[float] = []
    with tempfile.TemporaryDirectory() as folder:
        for share in (0.25, 1.0, 2.0):
            path = Path(folder) / f"{share:g}.parquet"
            samples = int(hour * share)
            write_log(path, samples)
            told = _identified(path)
            if share == 1.0:
                figures += _from_csv(path, quick=quick)
            path.unlink()
            peaks.append(told["peak_mb"])
            targets = ("<= 10", "<= 600") if share == 1.0 and not quick else ("", "")
            stages = ", ".join(f"{name} {spent:.2f}" for name, spent in told["stages"].items())
            figures += [
                Figure(f"{samples} samples, processor s", f"{told['seconds']:.2f}", targets[0], stages),
                Figure(f"{samples} samples, peak MB", f"{told['peak_mb']:.0f}", targets[1]),
            ]
    return [
        *figures,
        Figure("peak at twice the length over a quarter", f"{peaks[2] / peaks[0]:.2f}", "<= 1.1", ratio=True),
    ]


def _from_csv(path: Path, *, quick: bool) -> list[Figure]:
    """Run the same log as text."""
    text = path.with_suffix(".csv")
    arrow_csv.write_csv(pq.read_table(path), text)
    told, size = _identified(text), text.stat().st_size / 1e6
    text.unlink()
    read = f"{size:.0f} MB read in {told['stages']['read']:.2f} s"
    return [
        Figure("the same from CSV, processor s", f"{told['seconds']:.2f}", "" if quick else "<= 3", read),
        Figure("the same from CSV, peak MB", f"{told['peak_mb']:.0f}"),
    ]


def write_log(path: Path, samples: int) -> None:
    """Write a log of smooth random motion with noisy torque, piece by piece."""
    scene, motion = yumi_arm(), smooth_motion(7)
    rng = np.random.default_rng(5)
    names = ["time", *(f"{kind}_{joint}" for kind in ("q", "tau") for joint in range(1, 8))]
    noise = NOISE_SHARE * scene.torque(motion.at(np.arange(PIECE) / RATE_HZ)).std(axis=0)
    with pq.ParquetWriter(path, pa.schema([(name, pa.float64()) for name in names])) as writer:
        for begin in range(0, samples, PIECE):
            time = np.arange(begin, min(begin + PIECE, samples)) / RATE_HZ
            state = motion.at(time)
            torque = scene.torque(state) + noise * rng.normal(size=state.position.shape)
            columns = [time, *state.position.T, *torque.T]
            writer.write_table(pa.table(dict(zip(names, columns, strict=True))))


def _identified(path: Path) -> dict[str, Any]:
    command = [sys.executable, "-m", "benchmarks.hour_worker", str(path)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return dict(json.loads(done.stdout))
