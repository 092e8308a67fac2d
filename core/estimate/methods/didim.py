"""Fit simulated columns to the measured torque, under the constraints of physical consistency.

The measured motion gives no column: what the robot that was found last does in the loop gives them, and
friction where a joint sticks is what holds it there. Where the motion hardly depends on the parameters, the
simulated torque is Ws chi with Ws as its derivative, and least squares is a Gauss-Newton step. Source:
Gautier, Janot & Vandanjon, IEEE TCST 21(2), 2013 (DIDIM).
"""

from dataclasses import dataclass

from ...arrays import Parameters
from .method import FitData
from .simulating import Simulating


@dataclass(frozen=True)
class DirectInverse(Simulating):
    """Fit simulated columns to the measured torque."""

    name: str = "didim"
    title: str = "simulated columns (DIDIM), physically consistent"

    def with_columns(self, at: Parameters, data: FitData) -> FitData:
        """Put the simulated columns in the place of the measured ones."""
        return data.simulated(at).discounted()
