"""Fit by instrumental variables under the constraints of physical consistency.

Errors of the measured motion stand in the columns of the equations, and least squares is biased by them. The
columns Z of a simulated motion follow the true ones and hold little of these errors: Z'(y - W chi) = 0 is
solved, and Z is made again with the robot that was found. Source: Janot, Vandanjon & Gautier, IEEE TCST
22(1), 2014 (IDIM-IV).
"""

from dataclasses import dataclass

from ...arrays import Parameters
from .method import PERIODS, SIMULATED, FitData
from .simulating import Simulating


@dataclass(frozen=True)
class InstrumentalVariables(Simulating):
    """Solve the equations on the span of simulated columns."""

    name: str = "iv"
    title: str = "instrumental variables, physically consistent"
    sources: tuple[str, ...] = (*SIMULATED, PERIODS)

    def with_columns(self, at: Parameters, data: FitData) -> FitData:
        """Put the simulated columns before the measured ones."""
        return data.discounted().instrumented(at)
