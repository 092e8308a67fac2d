"""Fit by instrumental variables on rows that are prewhitened by a model of their errors.

Filtered errors are correlated, and those that noise of positions leaves grow with frequency. The residual's
autoregression weighs frequencies by their noise, as no cut-off does. Source: Brunot, Janot, Young & Carrillo,
Control Engineering Practice 74 (2018).
"""

from dataclasses import dataclass

from ...arrays import Parameters
from .method import PERIODS, SIMULATED, FitData
from .simulating import Simulating


@dataclass(frozen=True)
class PrewhitenedInstrumentalVariables(Simulating):
    """Solve prewhitened equations on the span of simulated columns, prewhitened alike."""

    name: str = "piv"
    title: str = "prewhitened instrumental variables, physically consistent"
    sources: tuple[str, ...] = (*SIMULATED, PERIODS)

    def with_columns(self, at: Parameters, data: FitData) -> FitData:
        """Put the simulated columns before the measured ones, and prewhiten both."""
        return data.prewhitened(at)
