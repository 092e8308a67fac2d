"""Diagnosis of measured robots, on motion held out of every fit: what is named, what it gains, what is left.

The logs are public and kept beside the project. Errors are the RMS of the residual over the RMS of the torque
per joint, both at the fit's band; targets are those joints' errors after the diagnosis.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from benchmarks.figures import Figure
from tests.measured import FRANKA_ROWS, TX40_TEST, TX40_TRAIN, measured_log, measured_robot
from veritorque.core.diagnosis.result import Finding
from veritorque.core.extension.result import Extension
from veritorque.core.log.model import JointLog
from veritorque.core.robot.model import RobotModel
from veritorque.core.study import IdentifyRequest, diagnose_in_full
from veritorque.core.validation.scores import JointScore

POINT_TO_POINT = "UR10e, point to point"


@dataclass(frozen=True)
class Run:
    """Name a robot's logs, which of them no fit sees, and the errors per joint that are to be reached, %."""

    robot: RobotModel
    logs: tuple[JointLog, ...]
    held_out: int | None
    targets: dict[int, float] = field(default_factory=dict)


def run(*, quick: bool) -> list[Figure]:
    """Diagnose every run, or half of the cheapest alone."""
    runs = {POINT_TO_POINT: _points(2070, 2450)} if quick else _runs()
    return [figure for name, one in runs.items() for figure in _figures(name, one)]


def _runs() -> dict[str, Run]:
    half = FRANKA_ROWS // 2
    fitted = (
        measured_log("ur10e_open", "fourier_30s_12h", 635, 3510),
        measured_log("ur10e_open", "fourier_20s_8h", 320, 2310),
    )
    held_out = measured_log("ur10e_open", "fourier_40s_12h", 500, 4460)
    panda = tuple(measured_log("franka_panda", "traj1", *rows) for rows in ((0, half), (half, FRANKA_ROWS)))
    tx40 = tuple(measured_log("staubli_tx40", "run1", *rows) for rows in (TX40_TRAIN, TX40_TEST))
    return {
        "TX40 without its coupling": Run(
            measured_robot("staubli_tx40", coupled=False), tx40, None, {5: 13.0, 6: 11.0}
        ),
        "UR10e": Run(measured_robot("ur10e_open"), (*fitted, held_out), 3, {1: 5.6, 2: 2.2, 3: 2.7}),
        POINT_TO_POINT: _points(),
        "Panda": Run(measured_robot("franka_panda"), panda, 2),
        "Rokae": Run(measured_robot("rokae_xmate3"), (measured_log("rokae_xmate3", "excit"),), None),
    }


def _points(fitted_until: int = 3510, held_out_until: int = 4200) -> Run:
    logs = (
        measured_log("ur10e_open", "fourier_30s_12h", 635, fitted_until),
        measured_log("ur10e_open", "validation_ptp_10pts", 700, held_out_until),
    )
    return Run(measured_robot("ur10e_open"), logs, 2)


def _figures(name: str, one: Run) -> list[Figure]:
    options = {"bootstrap": {"draws": 0}}
    if one.held_out is not None:
        options["validation"] = {"logs": [one.held_out]}
    found = diagnose_in_full(IdentifyRequest(one.robot, one.logs, options))
    causes = found.diagnosis.findings
    figures = [
        Figure(f"{name}: verdict", found.diagnosis.verdict),
        *(
            Figure(
                f"{name}: {finding.cause}, joint {' '.join(map(str, finding.joints))}",
                _gained(finding),
                "",
                "or " + ", ".join(alternative.cause for alternative in finding.ambiguous_with)
                if finding.ambiguous_with
                else "",
            )
            for finding in causes
        ),
    ]
    before, after = _errors(found)
    figures += [
        Figure(
            f"{name}: held-out error of joint {joint}, %",
            f"{new:.2f}",
            f"<= {one.targets[joint]}" if joint in one.targets else "",
            f"{old:.2f} before",
            ratio=True,
        )
        for joint, (old, new) in enumerate(zip(before, after, strict=True), start=1)
    ]
    left = ", ".join(f"{100.0 * part.share:.0f}" for part in found.diagnosis.predictable)
    return [*figures, Figure(f"{name}: predictable share of what is left per joint, %", left, ratio=True)]


def _gained(finding: Finding) -> str:
    """Say what a finding takes from the error on held-out rows, and what it brings, weighed by the noise."""
    if finding.gain is None:
        return ""
    error = f"{finding.gain.total_percent:.0f} % gained on held-out motion"
    compare_alternatives = [
        one.value for one in finding.evidence if one.statistic == "held-out likelihood ratio"
    ]
    return "; ".join([error, *(f"likelihood ratio {one:.0f} there" for one in compare_alternatives)])


def _errors(found: Extension) -> tuple[np.ndarray, np.ndarray]:
    after = found.after or found.before
    return _percents(found.before.validation), _percents(after.validation)


def _percents(scores: Sequence[JointScore]) -> np.ndarray:
    return np.array([one.nrmse_of_rms_percent for one in scores])
