"""Compare two identifications: which parameters differ by more than noise explains.

Here the same arm was logged twice, the second time with something hidden in it. A difference is stated in
standard deviations; among 71 parameters a few beyond 2 are expected by chance, and none beyond 4. Run
``python -m examples.05_compare``.
"""

from pathlib import Path

import numpy as np

from veritorque import IdentifyRequest, builtin_robot, identify, read_log
from veritorque.app.client.result import Result

YUMI = Path(__file__).parent / "yumi"
FAR = 4.0


def identified(log: Path) -> Result:
    """Identify the left arm from a log."""
    request = IdentifyRequest(builtin_robot("yumi-left"), (read_log(log),), {"bootstrap": {"draws": 0}})
    return Result.from_document(identify(request))


def main() -> None:
    """Identify twice and compare."""
    one, other = identified(YUMI / "log.csv").base, identified(YUMI / "hidden_log.csv").base
    spread = np.hypot(one.standard_deviation, other.standard_deviation)
    distance = (other.value - one.value) / spread
    far = int((abs(distance) > FAR).sum())
    print(f"{far} of {len(one)} parameters differ by more than {FAR:.0f} deviations")
    for row in abs(distance).argsort()[::-1][:5]:
        change = f"{one.value[row]:9.4f} -> {other.value[row]:9.4f} {one.unit[row]}"
        print(f"{one.name[row]:6} {change:36} {distance[row]:+.1f}")


if __name__ == "__main__":
    main()
