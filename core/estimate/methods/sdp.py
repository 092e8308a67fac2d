"""Fit by weighted least squares under the constraints of physical consistency: the default.

Source: Sousa & Cortesao 2014; Wensing, Kim & Slotine 2018.
"""

from dataclasses import dataclass

from .wls import WeightedLeastSquares


@dataclass(frozen=True)
class SemidefiniteProgramme(WeightedLeastSquares):
    """Write the equations of weighted least squares, to be solved by the semidefinite programme."""

    name: str = "sdp"
    title: str = "weighted, physically consistent"
    feasible: bool = True
