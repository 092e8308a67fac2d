"""Say where a Kalman filter begins, and which noise it assumes.

The noise of positions is what cubics through five neighbours leave of them. That of torques is what the
equations of simulated columns leave, in which noise of positions has little part.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import solve_triangular

from ...arrays import BaseParameters, JointVector, Parameters, SquareMatrix
from ...reduction.base import BaseModel
from ...signals.condition import Motion
from ...signals.survey import survey_of
from ..options import LEAST_SCALE, KalmanOptions
from ..system import System

LEAST_NOISE = 1e-9
"""Least deviation of positions, rad or m, of a log that shows no noise."""
_FOURTH = np.array([1.0, -4.0, 6.0, -4.0, 1.0])


@dataclass(frozen=True, eq=False)
class FilterStart:
    """Hold where a filter begins, and what it assumes."""

    base: BaseModel
    standard: Parameters
    system: System
    """The weighted equations of columns that are simulated there."""
    torque_rms: JointVector
    """Of the filtered torque, N m."""
    substeps: int | None
    options: KalmanOptions
    unscented: bool

    @property
    def values(self) -> BaseParameters:
        """Give the base parameters."""
        return self.base.base_of(self.standard)

    @property
    def factor(self) -> SquareMatrix:
        """Give the triangle U of the parameters' covariance U'U: that of the equations, made wider.

        No parameter is left wider than makes all of the torque, and one that makes none does not move.
        """
        triangle = self.system.triangle
        norms = np.linalg.norm(triangle, axis=0)
        idle = norms == 0.0
        widest = np.where(idle, 1.0, np.linalg.norm(self.system.target) / np.where(idle, 1.0, norms))
        rows = np.vstack([triangle / self.options.start_scale, np.diag(1.0 / widest)]) * widest
        known = np.linalg.qr(rows, mode="r")
        upper = np.linalg.qr(solve_triangular(known, np.eye(len(known)), trans="T"), mode="r")
        return np.where(idle | idle[:, None], 0.0, np.asarray(upper) * widest)

    def narrowed(self, share: float) -> "FilterStart":
        """Give the same with parameters that begin a share as wide."""
        scale = max(share * self.options.start_scale, LEAST_SCALE)
        return replace(self, options=replace(self.options, start_scale=scale))

    @property
    def separates(self) -> bool:
        """Tell whether the motion says more of every combination of parameters than the filter begins with.

        Nothing is asked of parameters that make no torque: they do not move.
        """
        norms = np.linalg.norm(self.system.triangle, axis=0)
        shown = self.system.triangle[:, norms > 0.0] / norms[norms > 0.0]
        least = np.linalg.norm(self.system.target) * np.linalg.svd(shown, compute_uv=False).min(initial=1.0)
        return bool(least > self.options.start_scale)

    def variance(self, motion: Motion) -> JointVector:
        """Give the variance of a motion's measured positions, rad2 or m2."""
        return np.asarray(self.options.position_noise**2 * position_variance(motion))


def position_variance(motion: Motion) -> JointVector:
    """Give the variance of the measured positions, rad2 or m2, from their deviation from cubics."""
    survey = survey_of(motion.log, motion.recipe.median_order)
    beyond = [np.mean(np.diff(window, 4, axis=0) ** 2, axis=0) for window in survey.positions]
    return np.asarray(np.maximum(np.mean(beyond, axis=0) / float(np.sum(_FOURTH**2)), LEAST_NOISE**2))
