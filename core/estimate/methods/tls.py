"""Fit by least squares with the bias taken out that noise of positions gives it.

Total least squares in its weighted form, with a known covariance of the columns' errors. Those enter by the
accelerations; the sign of a noisy speed has no linear model and is not compensated. Source: Fuller,
Measurement Error Models (1987), ch. 3.1; Van Huffel & Vandewalle, The Total Least Squares Problem (1991).
"""

from dataclasses import dataclass

from ...arrays import Parameters
from ..system import REWEIGHTINGS, joint_noise, ordinary, stacked
from .method import FitData, Step


@dataclass(frozen=True)
class CompensatedLeastSquares:
    """Weight the equations per joint, and take expected products of noise out of them."""

    name: str = "tls"
    title: str = "noise of columns compensated, physically consistent"
    needs: tuple[str, ...] = ()
    feasible: bool = True
    iterative: bool = False
    sources: tuple[str, ...] = ()
    row_weights: bool = False

    def equations(self, at: Parameters | None, data: FitData) -> Step:  # noqa: ARG002  (the same at any robot)
        """Write the equations, which are the same at any robot."""
        own = data.compensated()
        system = ordinary(own.factors, own.columns_of, own.size)
        for _ in range(REWEIGHTINGS):
            noise = joint_noise(own.factors, own.columns_of, system.solved())
            system = stacked(own.factors, own.columns_of, own.size, noise, own.criterion)
        return Step(system, own)
