"""Read spoilt files one after the other, in processes that may die, and count how each reading ended.

A case is a format, a seed and a number, and the same file again whenever it is asked for. A reader that dies
of a signal takes its process with it; the campaign notes the case and goes on behind it.
"""

import ctypes
import faulthandler
import gc
import mmap
import os
import resource
import signal
import struct
import time
import warnings
from collections import Counter
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from random import Random
from statistics import median

from tests.fuzz.mutation import spoilt
from tests.fuzz.seeds import seeds
from veritorque.app.inspection.log_reading import LogFile, summarise_log
from veritorque.app.json_text import json_bytes
from veritorque.core.errors import VeritorqueError

MEMORY = 400 << 20
HANG_S = 20.0
SLOW_S = 1.0
SETTLED = 500
MAPPING = {"profile": "ros-jointstate"}
"""It changes nothing for files whose columns have default names."""
ENDINGS = ("refused", "accepted", "out of memory", "untyped")
STATE = struct.Struct("=qdqqqqqqq")


@dataclass
class Tally:
    """Count the endings of the readings of one format.

    Attributes
    ----------
    deaths
        Cases whose reader died, with the signal: the service answers them by a problem.
    untyped
        Cases which raised what is no error of ours.
    slow, hung
        Cases that took more than a second of processor time, or never came back.
    growth_kb
        Memory that the reading process gained steadily, and in how many readings: the median of steps of
        `SETTLED` readings, for one large file leaves a hole behind, whereas a leak goes on.
    """

    form: str
    endings: Counter[str] = field(default_factory=Counter)
    deaths: list[tuple[int, int]] = field(default_factory=list)
    untyped: list[int] = field(default_factory=list)
    hung: list[int] = field(default_factory=list)
    slow: int = 0
    growth_kb: int = 0
    grown_in: int = 0

    @property
    def runs(self) -> int:
        return self.endings.total() + len(self.deaths) + len(self.hung)


def case(form: str, seed: int, number: int) -> bytes:
    """Give the spoilt file of a case."""
    return spoilt(form, seeds()[form], Random(f"{form} {seed} {number}"))  # noqa: S311  (repeatable)


def read(path: Path) -> str:
    """Read a file as the service does, and name the ending.

    Raises
    ------
    Exception
        What is no error of ours: that is what the campaign looks for.
    """
    try:
        json_bytes(summarise_log(LogFile(path, "fuzz", MAPPING, "0" * 64), media_type=None))
    except VeritorqueError:
        return "refused"
    except MemoryError:
        return "out of memory"
    return "accepted"


def run(form: str, *, runs: int, seed: int, folder: Path) -> Tally:
    """Read so many spoilt files of a format."""
    tally, state = Tally(form), mmap.mmap(-1, STATE.size)
    done = 0
    while done < runs:
        state[:] = STATE.pack(done, time.monotonic(), *([0] * 7))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of threads, none of which reads
            child = os.fork()
        if child == 0:
            _work(form, range(done, runs), seed, folder / "upload", state)
        status = _await(child, state)
        number, _, *counts, grown_kb, grown_in = STATE.unpack(state)
        for name, count in zip((*ENDINGS, "slow"), counts, strict=True):
            if name == "slow":
                tally.slow += count
            else:
                tally.endings[name] += count
        tally.growth_kb, tally.grown_in = tally.growth_kb + grown_kb, tally.grown_in + grown_in
        if os.WIFEXITED(status) and os.WEXITSTATUS(status) == 0:
            return tally
        if os.WIFEXITED(status):
            tally.untyped.append(number)
        elif os.WTERMSIG(status) == signal.SIGKILL:
            tally.hung.append(number)
        else:
            tally.deaths.append((number, os.WTERMSIG(status)))
        done = number + 1
    return tally


def _await(child: int, state: mmap.mmap) -> int:
    """Wait for the reading process; kill it where a reading does not end."""
    while True:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            return status
        if time.monotonic() - STATE.unpack(state)[1] > HANG_S:
            os.kill(child, signal.SIGKILL)
        time.sleep(0.01)


def _work(form: str, numbers: range, seed: int, path: Path, state: mmap.mmap) -> None:
    """Read on; the code of the exit is 0 at the end and 1 after an error that is not ours."""
    faulthandler.disable()  # a crash is counted, not printed
    _limit_memory()
    warnings.simplefilter("error")  # whoever reads the service's log shall not read of every spoilt file
    counts = dict.fromkeys((*ENDINGS, "slow"), 0)
    levels: list[int] = []
    grown = (0, 0)
    for index, number in enumerate(numbers):
        state[:] = STATE.pack(number, time.monotonic(), *counts.values(), *grown)
        path.write_bytes(case(form, seed, number))
        begin = time.process_time()
        try:
            ending = read(path)
        except BaseException:  # noqa: BLE001  (errors of other types are what it searches)
            counts["untyped"] += 1
            state[:] = STATE.pack(number, time.monotonic(), *counts.values(), *grown)
            os._exit(1)
        counts[ending] += 1
        counts["slow"] += time.process_time() - begin > SLOW_S
        if index and index % SETTLED == 0:
            levels.append(_resident_kb())
            steps = [later - earlier for earlier, later in pairwise(levels)] or [0]
            grown = (round(median(steps) * len(steps)), SETTLED * len(steps))
    state[:] = STATE.pack(numbers[-1], time.monotonic(), *counts.values(), *grown)
    os._exit(0)


def _limit_memory() -> None:
    used = int(Path("/proc/self/statm").read_text().split()[5]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_DATA, (used + MEMORY, used + MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def _resident_kb() -> int:
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)  # what is free but not given back is no leak
    return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize() // 1024
