"""Works for the processes of the executor, which import them by name: one ends well, the others end badly."""

import os
import signal
import sys
import time

import numpy as np

from core.errors import ExcitationError


def echo(computation, progress):
    progress("echo", 0.5)
    return {"robot": computation.robot, "options": computation.options, "pid": os.getpid()}


def sleep(computation, progress):
    progress("sleep", 0.1)
    time.sleep(60.0)


def refuse(computation, progress):
    raise ExcitationError(
        "the motion is too slow",
        evidence={"speed": np.float64(0.01), "bad": float("nan")},
        remedy="move faster",
    )


def stumble(computation, progress):
    raise KeyError("a secret of ours")


def exhaust(computation, progress):
    raise MemoryError


def vanish(computation, progress):
    os.kill(os.getpid(), signal.SIGKILL)


def leave(computation, progress):
    sys.exit(3)


def not_finite(computation, progress):
    return {"value": float("nan")}


def name_yourself(computation, progress):
    progress(str(os.getpid()), 0.0)
    time.sleep(60.0)
