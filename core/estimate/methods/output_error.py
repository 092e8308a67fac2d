"""Fit what a simulated robot does to what the log shows, under the constraints of physical consistency.

The residual is that of a simulated output: the drives' torque (closed-loop input error), the positions
(closed-loop output error), or the positions of free motion over short windows (output error). Its derivatives
are exact but for differences, so that every step is one of Gauss and Newton. Sources: Landau, Automatica 33,
1997; Gautier, Janot & Vandanjon, IEEE TCST 21(2), 2013; Ljung, System Identification (1999).
"""

from dataclasses import dataclass

from ...arrays import Parameters
from .method import POSITION, TORQUE, WINDOWS, FitData
from .simulating import Simulating


@dataclass(frozen=True)
class OutputError(Simulating):
    """Compare an output of the simulation with the log."""

    output: str = POSITION

    def with_columns(self, at: Parameters, data: FitData) -> FitData:
        """Put the derivatives of the simulated output in the place of the columns."""
        return data.differentiated(at, self.output).discounted()


CLOSED_LOOP_INPUT_ERROR = OutputError(
    "clie", "simulated torque (closed-loop input error), physically consistent", output=TORQUE
)
CLOSED_LOOP_OUTPUT_ERROR = OutputError(
    "cloe", "simulated motion (closed-loop output error), physically consistent", output=POSITION
)
OPEN_LOOP_OUTPUT_ERROR = OutputError(
    "oe", "free motion over short windows (output error), physically consistent", output=WINDOWS, sources=()
)
