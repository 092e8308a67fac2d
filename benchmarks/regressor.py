"""The regressor's columns for YuMi's 7-joint arm, against a loop over pinocchio in the same run.

All base columns of the standard model, drives included, are compared with pinocchio's rigid body alone.
"""

import numpy as np

from benchmarks.figures import Figure, processor_seconds
from benchmarks.peer import base_columns, pinocchio_model, regressors
from benchmarks.scene import RATE_HZ, smooth_motion, yumi_arm
from veritorque.core.signals.state import MotionState

STRETCH = 2048
"""Samples at a time, about what a tile of a log holds."""


def run(*, quick: bool) -> list[Figure]:
    """Time both on the same motion and compare every column."""
    scene = yumi_arm()
    state = smooth_motion(7).at(np.arange(STRETCH) / RATE_HZ)
    model = pinocchio_model(scene.robot)
    repeats = 3 if quick else 15
    loop = processor_seconds(lambda: regressors(model, state), repeats=repeats) / STRETCH * 1e6
    ours = processor_seconds(lambda: scene.plan.series(state), repeats=repeats) / STRETCH * 1e6
    loop_again = processor_seconds(lambda: regressors(model, state), repeats=repeats) / STRETCH * 1e6
    ratio = 0.5 * (loop + loop_again) / ours
    return [
        Figure("regressor, us/sample", f"{ours:.3f}", "<= 0.35", f"pinocchio {loop:.2f}"),
        Figure("times faster than pinocchio's loop", f"{ratio:.1f}", ">= 12", ratio=True),
        Figure(
            "largest relative difference", f"{difference(state):.1e}", "<= 1e-12", "pinocchio", ratio=True
        ),
    ]


def difference(state: MotionState) -> float:
    """Give the largest difference from pinocchio's columns, relative to the parameter's largest torque."""
    scene = yumi_arm()
    theirs = base_columns(pinocchio_model(scene.robot), scene.base, state)
    worst = 0.0
    for (joint, column), row in zip(scene.plan.entries, scene.plan.series(state), strict=True):
        size = np.abs(theirs[:, :, column]).max()
        worst = max(worst, float(np.abs(row - theirs[:, joint, column]).max() / size))
    return worst
