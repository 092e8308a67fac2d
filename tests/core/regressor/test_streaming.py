"""The matrix of a long log is never stored: four times the samples need hardly more memory."""

import os
import subprocess
import sys

STUDY = """
import re
from pathlib import Path
import numpy as np
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.model import JointLog, LogRows
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan
from veritorque.core.regressor.observe import observe
from veritorque.core.robot.builtin import builtin_robot
from veritorque.core.signals.condition import condition
from veritorque.core.signals.recipe import FilterOptions

class Generated:
    samples = {samples}

    def rows(self, start, stop):
        time = np.arange(start, stop) / 250.0
        position = np.sin(np.outer(time, np.linspace(1.0, 3.0, 7)))
        return LogRows(time, position, np.cos(position))

robot = builtin_robot("yumi-left")
log = JointLog("generated", Generated(), 7, 250.0, {samples} / 250.0, ((0, {samples}),))
options = FilterOptions(cutoff_hz=10.0, position_cutoff_hz=40.0, decimation=10)
base = base_model(standard_model(robot))
observation = observe(ColumnPlan(base.model, base.kept), (condition(log, robot, options),))
assert observation.kept == {samples} // 10
status = Path("/proc/self/status").read_text()  # getrusage would count the process this one was forked from
print(int(re.search(r"VmHWM:\\s+(\\d+)", status)[1]) / 1024.0)
"""


def _peak_megabytes(samples: int) -> float:
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", STUDY.format(samples=samples)],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": ".", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
    )
    return float(done.stdout)


def test_a_log_four_times_as_long_needs_no_more_memory_than_its_stamps():
    # W of the longer log holds 180,000 rows more of 7 x 71 numbers: 700 MB, 70 MB when thinned.
    assert _peak_megabytes(240_000) - _peak_megabytes(60_000) < 25.0
