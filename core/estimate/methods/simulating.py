"""Hold what estimators on simulated motion have in common: they iterate, and stay physically consistent."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

from ...arrays import Parameters
from .method import SIMULATED, FitData, Step
from .wls import joint_equations


@dataclass(frozen=True)
class Simulating(ABC):
    """Write the equations of weighted least squares first, then those with simulated columns."""

    name: str
    title: str
    needs: tuple[str, ...] = ()
    feasible: bool = True
    iterative: bool = True
    row_weights: bool = False
    sources: tuple[str, ...] = SIMULATED

    def equations(self, at: Parameters | None, data: FitData) -> Step:
        """Write the equations at a robot; at None those of weighted least squares."""
        return joint_equations(data.discounted() if at is None else self.with_columns(at, data))

    @abstractmethod
    def with_columns(self, at: Parameters, data: FitData) -> FitData:
        """Give the data with the simulated columns of a robot of these standard parameters."""
