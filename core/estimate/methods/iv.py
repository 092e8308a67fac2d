"""Fit by instrumental variables under the constraints of physical consistency.

Errors of the measured motion stand in the columns of the equations, and least squares is biased by them. The
columns Z of a simulated motion follow the true ones and hold little of these errors: Z'(y - W chi) = 0 is
solved, and Z is made again with the robot that was found. Source: Janot, Vandanjon & Gautier, IEEE TCST
22(1), 2014 (IDIM-IV).
"""

from dataclasses import dataclass

from ...arrays import Parameters
from .method import FitData, Step
from .wls import joint_equations


@dataclass(frozen=True)
class InstrumentalVariables:
    """Solve the equations on the span of simulated columns."""

    name: str = "iv"
    title: str = "instrumental variables, physically consistent"
    needs: tuple[str, ...] = ()
    feasible: bool = True
    iterative: bool = True
    row_weights: bool = False

    def equations(self, at: Parameters | None, data: FitData) -> Step:
        """Write the equations at a robot; before there is any, those of weighted least squares."""
        if at is None:
            return joint_equations(data.discounted())
        return joint_equations(data.discounted().instrumented(at))
