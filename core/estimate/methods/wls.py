"""Fit by weighted least squares: every joint counts by the noise of its own residual.

Source: Gautier 1997 (IDIM-LS); Khalil & Dombre (2002), ch. 12.
"""

from dataclasses import dataclass

from ...arrays import BaseParameters
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
    row_weights: bool = True

    def equations(self, at: BaseParameters | None, data: FitData) -> Step:  # noqa: ARG002  (the same at any robot)
        """Write the equations, which are the same at any robot."""
        data = data.discounted()
        if data.robust:
            return huber_equations(data)
        return Step(weighted(data.factors, data.columns_of, data.size), data)
