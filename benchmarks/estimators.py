"""Every estimator on noisy logs of arms that stick: error of the torque on motions that were not seen.

Arms of another engine, 10 s at 1 kHz, with white noise of encoders and torques that is the same for all. The
error is the RMS over draws; its bias is the error of the mean of all estimates. A draw that fails counts as
an error of 100 %, and is counted. Where the filter is chosen by the product, it is as narrow as the encoders'
noise asks for; a wide one shows what noise does to columns.
"""

from collections.abc import Mapping
from itertools import product
from time import process_time

import numpy as np

from benchmarks.figures import Figure
from tests.core.estimate.sticking_arm import Scene, scene
from veritorque.core.errors import VeritorqueError
from veritorque.core.estimate.methods.registry import ESTIMATORS
from veritorque.core.log.model import JointLog

DRAWS = 50
ARMS = ("planar-2", "ur10e")
NOISES = ((1e-3, 0.02), (1e-2, 0.02), (1e-2, 0.2), (1e-1, 0.2))
"""RMS noise of encoders in degrees, and of torques as a share of the plant's usual one."""
WIDE: Mapping[str, object] = {"filter": {"cutoff_hz": 40.0}}


def run(*, quick: bool) -> list[Figure]:
    """Measure every estimator at every noise; the wide filter at the second one."""
    draws, arms = (5, ARMS[:1]) if quick else (DRAWS, ARMS)
    figures: list[Figure] = []
    for arm, noise in product(arms, NOISES):
        figures += [_measured(arm, noise, name, {}, draws) for name in ESTIMATORS]
    return figures + [_measured(arms[0], NOISES[1], name, WIDE, draws) for name in ESTIMATORS]


def _measured(
    arm: str, noise: tuple[float, float], estimator: str, options: Mapping[str, object], draws: int
) -> Figure:
    own = scene(arm)
    logs = [own.log(*noise, seed) for seed in range(draws)]
    begun = process_time()
    estimates = [_estimated(own, log, estimator, options) for log in logs]
    spent = (process_time() - begun) / draws
    found = [base for base in estimates if base is not None]
    failed = draws - len(found)
    errors = [own.error(base) for base in found] + [100.0] * failed
    bias = f"bias {own.error(np.mean(found, axis=0)):.3f} %, " if found else ""
    band = ", 40 Hz" if options else ""
    return Figure(
        f"{arm}, {noise[0]:g} deg, torque {noise[1]:g}{band}: {estimator}, %",
        f"{np.sqrt(np.mean(np.square(errors))):.3f}",
        "",
        f"{bias}{failed} of {draws} failed, {spent:.2f} s",
        ratio=True,
    )


def _estimated(own: Scene, log: JointLog, estimator: str, options: Mapping[str, object]) -> np.ndarray | None:
    try:
        return own.estimated(log, estimator, options)
    except VeritorqueError:
        return None
