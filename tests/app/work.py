"""Works for the processes of the executor, which import them by name: one ends well, the others end badly."""

import errno
import os
import signal
import sys
import time

import numpy as np

from veritorque.core.errors import ExcitationError


def echo(computation, workspace, progress):
    progress("echo", 0.5)
    return {"robot": computation.robot, "options": computation.options, "pid": os.getpid()}


def sleep(computation, workspace, progress):
    progress("sleep", 0.1)
    time.sleep(60.0)


def refuse(computation, workspace, progress):
    raise ExcitationError(
        "the motion is too slow",
        evidence={"speed": np.float64(0.01), "bad": float("nan")},
        remedy="move faster",
    )


def stumble(computation, workspace, progress):
    raise KeyError("a secret of ours")


def hoard(computation, workspace, progress):
    kept = [np.ones(2**24) for _ in range(64)]  # 128 MiB each
    return {"kept": len(kept)}


def spin(computation, workspace, progress):
    signal.signal(signal.SIGALRM, lambda *_: progress("spun", 1.0))
    while True:
        pass


def name_your_cpus(computation, workspace, progress):
    progress(" ".join(map(str, os.sched_getaffinity(0))), 0.0)
    time.sleep(60.0)


def vanish(computation, workspace, progress):
    os.kill(os.getpid(), signal.SIGKILL)


def fill_the_disk(computation, workspace, progress):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def leave(computation, workspace, progress):
    sys.exit(3)


def not_finite(computation, workspace, progress):
    return {"value": float("nan")}


def name_yourself(computation, workspace, progress):
    progress(str(os.getpid()), 0.0)
    time.sleep(60.0)


def answer(pipe):
    """Say who answers; the task of a process that waits for one."""
    pipe.recv()
    pipe.send(os.getpid())


def rehearse_for_ever(progress):
    while True:
        progress("again", 0.0)
        time.sleep(0.01)


def refuse_to_rehearse(progress):
    raise OSError("there is no room for temporary files")
