"""Identify a robot from a log, in this process: nothing runs beside it, nothing is kept.

Run ``python -m examples.01_identify``; it writes `result.json` beside you, which the other examples read too.
"""

from pathlib import Path

from veritorque import IdentifyRequest, builtin_robot, identify, read_log
from veritorque.app.client.result import Result

LOG = Path(__file__).parent / "yumi" / "log.csv"


def main() -> None:
    """Read, identify, look, save."""
    log = read_log(LOG)
    for defect in log.defects:
        print(f"defect: {defect.statement}")

    document = identify(IdentifyRequest(builtin_robot("yumi-left"), (log,), {"bootstrap": {"draws": 0}}))
    result = Result.from_document(document)

    print(f"physically {'consistent' if result.physically_consistent else 'inconsistent'}")
    print("joint  error on held-out motion, % of RMS")
    for joint, error in zip(result.validation.joint, result.validation.nrmse_of_rms_percent, strict=True):
        print(f"{joint:5}  {error:.2f}")
    print("the five best determined parameters")
    base = result.base
    for row in base.relative_deviation_percent.argsort()[:5]:
        known = base.relative_deviation_percent[row]
        print(f"{base.name[row]:6} {base.value[row]:9.4f} {base.unit[row]:10} {known:.2f} %")
    result.save("result.json")


if __name__ == "__main__":
    main()
