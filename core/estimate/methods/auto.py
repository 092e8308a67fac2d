"""Leave the choice of the estimator to the noise of the log: least squares, or what noise of columns spares.

The choice needs a fit, so it is made where fits are. Its first equations are those of least squares.
"""

from dataclasses import dataclass

from .method import SIMULATED
from .sdp import SemidefiniteProgramme

AUTO = "auto"


@dataclass(frozen=True)
class Automatic(SemidefiniteProgramme):
    """Begin with least squares."""

    name: str = AUTO
    title: str = "chosen by the noise of the positions"
    iterative: bool = True
    sources: tuple[str, ...] = SIMULATED
