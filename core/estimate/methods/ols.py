"""Fit by ordinary least squares: every row counts alike, whatever the noise of its joint."""

from dataclasses import dataclass

from ...arrays import Parameters
from ..system import ordinary
from .method import FitData, Step


@dataclass(frozen=True)
class OrdinaryLeastSquares:
    """Stack the joints' equations as they are."""

    name: str = "ols"
    title: str = "ordinary least squares"
    needs: tuple[str, ...] = ()
    feasible: bool = False
    iterative: bool = False
    sources: tuple[str, ...] = ()
    row_weights: bool = False

    def equations(self, at: Parameters | None, data: FitData) -> Step:  # noqa: ARG002  (the same at any robot)
        """Write the equations, which are the same at any robot."""
        return Step(ordinary(data.factors, data.columns_of, data.size), data)
