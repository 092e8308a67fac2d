"""Hold a computation to its share of the machine, from within its own process.

What the system enforces holds whatever library misbehaves. Sources: setrlimit(2) (RLIMIT_DATA counts memory
that is mapped as well, since Linux 4.7); sched_setaffinity(2); unix(7) on abstract addresses, which the
system frees when a process ends, however it ends.
"""

import math
import os
import resource
import socket
import sys
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

_reserved: list[socket.socket] = []
"""Addresses that stand for CPUs, held as long as this process lives."""


@dataclass(frozen=True)
class Limits:
    """Say what a computation may use."""

    memory_bytes: int = 4 * 1024**3
    """Most memory it may write to, beside what its code needs."""
    cpus: int = 1
    """CPUs that it computes on."""

    def hold(self) -> None:
        """Hold this process to the limits from now on."""
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))  # a dump would hold the logs and fill the disk
        _limit(resource.RLIMIT_DATA, self.memory_bytes)
        if sys.platform == "linux":
            with suppress(OSError):  # where memory runs out all the same, the service is not who ends
                Path("/proc/self/oom_score_adj").write_text("1000")
            _pin(self.cpus)

    def hold_to_time(self, seconds: float) -> None:
        """Hold this process to the CPU time that so many seconds from now on allow."""
        _limit(resource.RLIMIT_CPU, math.ceil(time.process_time() + self.cpus * seconds) + 1)

    def lift_memory(self) -> None:
        """Raise the limit again, so that the process can report that it had too little memory."""
        _, most = resource.getrlimit(resource.RLIMIT_DATA)
        resource.setrlimit(resource.RLIMIT_DATA, (most, most))


def _limit(what: int, wanted: int) -> None:
    _, most = resource.getrlimit(what)
    wanted = wanted if most == resource.RLIM_INFINITY else min(wanted, most)
    resource.setrlimit(what, (wanted, most))


def _pin(count: int) -> None:
    """Stay on so many CPUs, on such that no other computation of this machine has, where there are."""
    allowed = sorted(os.sched_getaffinity(0))
    chosen = [cpu for cpu in allowed if len(_reserved) < count and _take(cpu)]
    others = [cpu for cpu in allowed if cpu not in chosen]
    turn = os.getpid() % len(allowed)  # computations that have to share do not all share the same one
    others = others[turn:] + others[:turn]
    os.sched_setaffinity(0, chosen + others[: count - len(chosen)])


def _take(cpu: int) -> bool:
    address = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    try:
        address.bind(f"\0veritorque-cpu-{cpu}")
    except OSError:
        address.close()
        return False
    _reserved.append(address)
    return True
