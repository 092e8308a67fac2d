"""Identify from one file and tell, as JSON, the processor time by stage and the peak of memory.

A process of its own, so that nothing but the identification is counted.
"""

import json
import re
import sys
import time
from pathlib import Path


def main() -> None:
    """Read the file named on the command line, identify, and print."""
    from veritorque.core.log.reader import read_log
    from veritorque.core.robot.builtin import builtin_robot
    from veritorque.core.study import IdentifyRequest, identify

    marks = [("imports", time.process_time())]
    log = read_log(Path(sys.argv[1]))
    marks.append(("read", time.process_time()))
    stages: dict[str, float] = {}
    now = ["start"]

    def progress(stage: str, _done: float) -> None:
        _charge(stages, now[0], marks)
        now[0] = stage

    options = {"bootstrap": {"draws": 0}}
    document = identify(IdentifyRequest(builtin_robot("yumi-left"), (log,), options), progress)
    _charge(stages, now[0], marks)
    spent = {"imports": marks[0][1], "read": marks[1][1] - marks[0][1], **stages}
    told = {
        "seconds": time.process_time(),
        "peak_mb": _peak_mb(),
        "stages": {name: seconds for name, seconds in spent.items() if seconds >= 0.005},
        "status": document["solver"]["status"],
    }
    sys.stdout.write(json.dumps(told))


def _peak_mb() -> float:
    """Read the peak since this program was loaded; getrusage would count the process it was forked from."""
    (kilobytes,) = re.findall(r"VmHWM:\s+(\d+) kB", Path("/proc/self/status").read_text())
    return int(kilobytes) / 1024.0


def _charge(stages: dict[str, float], stage: str, marks: list[tuple[str, float]]) -> None:
    """Add the time since the last mark to the stage that has just ended."""
    now = time.process_time()
    stages[stage] = stages.get(stage, 0.0) + now - marks[-1][1]
    marks.append((stage, now))


if __name__ == "__main__":
    main()
