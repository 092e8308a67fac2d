"""Take from this process, for good, what reading a file does not need: time, memory, writing, other files.

Limits are the kernel's, so that they hold within libraries that never come back to Python. Where the kernel
has Landlock (Linux 5.13), no file can be opened but the one to be read and Python's own.
Source: Linux, Documentation/userspace-api/landlock.rst; setitimer(2), setrlimit(2).
"""

import ctypes
import os
import re
import resource
import signal
import struct
import sys
import sysconfig
from dataclasses import dataclass
from pathlib import Path

from ... import app, core

CREATE_RULESET, ADD_RULE, RESTRICT_SELF = 444, 445, 446
VERSION_FLAG, PATH_BENEATH, NO_NEW_PRIVILEGES = 1, 1, 38
ALL_FILE_ACCESS = (1 << 13) - 1
READ_FILE, READ_DIRECTORY = 1 << 2, 1 << 3
ALL_TCP = 3
FIRST_WITH_TCP = 4
MEGABYTE = 1024**2


@dataclass(frozen=True)
class Budget:
    """Bound what one process may use."""

    processor_s: float
    """Processor time, s, which does not depend on what else the machine does."""
    wall_s: float
    """Time by the clock, s; it is there for processes that wait forever."""
    memory_bytes: int
    """Memory beyond what the loaded libraries take."""


def confine(path: Path, budget: Budget) -> None:
    """Bound this process to a budget, and to reading one file."""
    _limit(resource.RLIMIT_DATA, _memory_in_use() + budget.memory_bytes)
    _limit(resource.RLIMIT_CORE, 0)
    _limit(resource.RLIMIT_FSIZE, 0)
    _allow_only(path)
    signal.signal(signal.SIGPROF, signal.SIG_DFL)  # it ends the process, whatever it is doing
    signal.setitimer(signal.ITIMER_PROF, budget.processor_s)


def can_hide_files() -> bool:
    """Return whether the kernel can keep a process from opening files."""
    return sys.platform == "linux" and _call(CREATE_RULESET, None, 0, VERSION_FLAG) > 0


def _memory_in_use() -> int:
    status = Path("/proc/self/status")
    data = re.search(r"VmData:\s+(\d+) kB", status.read_text()) if status.exists() else None
    return int(data[1]) * 1024 if data else 0


def _limit(what: int, value: int) -> None:
    _, hard = resource.getrlimit(what)
    value = value if hard == resource.RLIM_INFINITY else min(value, hard)
    resource.setrlimit(what, (value, value))


def _allow_only(path: Path) -> None:
    if not can_hide_files():
        return
    version = _call(CREATE_RULESET, None, 0, VERSION_FLAG)
    handled = struct.pack("=QQ", ALL_FILE_ACCESS, ALL_TCP) if version >= FIRST_WITH_TCP else _FILES_ONLY
    rules = _call(CREATE_RULESET, handled, len(handled), 0)
    libraries = {sysconfig.get_path(name) for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    ours = {str(Path(package.__path__[0])) for package in (app, core)}
    for directory in sorted(libraries | ours):
        _permit(rules, directory, READ_FILE | READ_DIRECTORY)
    _permit(rules, str(path), READ_FILE)
    ctypes.CDLL(None).prctl(NO_NEW_PRIVILEGES, 1, 0, 0, 0)
    if _call(RESTRICT_SELF, rules, 0) != 0:
        raise OSError("the kernel refuses to hide files")
    os.close(rules)


_FILES_ONLY = struct.pack("=Q", ALL_FILE_ACCESS)


def _permit(rules: int, path: str, access: int) -> None:
    descriptor = os.open(path, os.O_PATH | os.O_CLOEXEC)
    _call(ADD_RULE, rules, PATH_BENEATH, struct.pack("=Qi", access, descriptor), 0)
    os.close(descriptor)


def _call(number: int, *arguments: int | bytes | None) -> int:
    given = (ctypes.c_long(value) if isinstance(value, int) else value for value in arguments)
    return int(ctypes.CDLL(None, use_errno=True).syscall(ctypes.c_long(number), *given))


def budget_for(size: int) -> Budget:
    """Give the budget of reading a file of so many bytes: a little in any case, and more the longer it is.

    A file that asks for much more than its bytes justify is made to hurt: it unpacks to a multiple of its
    size, or makes its reader turn in circles. What a sound file needs is a fraction of these figures.

    Examples
    --------
    >>> budget_for(0).processor_s, budget_for(20 * MEGABYTE).processor_s
    (1.0, 4.0)
    """
    processor_s = 1.0 + 0.15 * size / MEGABYTE
    return Budget(processor_s, 120.0 + 10.0 * processor_s, 160 * MEGABYTE + 6 * size)
