"""Fit by maximum likelihood of noisy torques and positions: all joints' rows of an instant weighted together.

Noise of an acceleration enters the rows of all joints that its inertia couples. The rows of an instant are
weighted by the inverse of their errors' covariance, which depends on the parameters, and noise of columns is
compensated as in `tls`, whose estimate and joint noises come first. Source: Fuller, Measurement Error Models
(1987), ch. 3.
"""

from dataclasses import dataclass

from ...arrays import Parameters
from ..system import stacked
from .method import FitData, Step
from .tls import CompensatedLeastSquares

ROUNDS = 2
"""A third changes no error on simulated arms."""


@dataclass(frozen=True)
class MaximumLikelihood(CompensatedLeastSquares):
    """Weight the rows of an instant by the inverse of their covariance."""

    name: str = "ml"
    title: str = "noise of columns compensated and weighted, physically consistent"

    def equations(self, at: Parameters | None, data: FitData) -> Step:
        """Write the equations, which are the same at any robot."""
        step = super().equations(at, data)
        noise = step.system.noise
        for _ in range(ROUNDS):
            own = data.whitened(step.system.solved(), noise)
            step = Step(stacked(own.factors, own.columns_of, own.size, noise, own.criterion), own)
        return step
