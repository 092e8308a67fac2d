"""Fit simulated columns to the measured torque, under the constraints of physical consistency.

The measured motion gives no column: what the robot that was found last does in the loop gives them, and
friction where a joint sticks is what holds it there. Where the motion hardly depends on the parameters, the
simulated torque is Ws chi with Ws as its derivative, and least squares is a Gauss-Newton step. Source:
Gautier, Janot & Vandanjon, IEEE TCST 21(2), 2013 (DIDIM).
"""

from dataclasses import dataclass

from ...arrays import Parameters
from .method import FitData, Step
from .wls import joint_equations


@dataclass(frozen=True)
class DirectInverse:
    """Write the equations of weighted least squares over simulated columns."""

    name: str = "didim"
    title: str = "simulated columns (DIDIM), physically consistent"
    needs: tuple[str, ...] = ()
    feasible: bool = True
    iterative: bool = True
    row_weights: bool = False

    def equations(self, at: Parameters | None, data: FitData) -> Step:
        """Write the equations at a robot; before there is any, those of weighted least squares."""
        if at is None:
            return joint_equations(data.discounted())
        return joint_equations(data.simulated(at).discounted())
