"""Fit by weighted least squares: every joint counts by the noise of its own residual.

Source: Gautier 1997 (IDIM-LS); Khalil & Dombre (2002), ch. 12.
"""

from dataclasses import dataclass

from ...arrays import Parameters
from ..system import weighted
from .irls import huber_equations
from .method import FitData, Step


@dataclass(frozen=True)
class WeightedLeastSquares:
    """Weight the equations per joint and beside its reversals, and per row for a robust fit."""

    name: str = "wls"
    title: str = "weighted, may be inconsistent"
    needs: tuple[str, ...] = ()
    feasible: bool = False
    iterative: bool = False
    sources: tuple[str, ...] = ()
    row_weights: bool = True

    def equations(self, at: Parameters | None, data: FitData) -> Step:  # noqa: ARG002  (the same at any robot)
        """Write the equations, which are the same at any robot."""
        return huber_equations(data.discounted()) if data.robust else joint_equations(data.discounted())


def joint_equations(data: FitData) -> Step:
    """Weight every joint by the noise of its own residual."""
    return Step(weighted(data.factors, data.columns_of, data.size, data.criterion), data)
