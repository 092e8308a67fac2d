"""Tell whether ten parameters that a fit found may be a body that was added or taken away."""

from functools import lru_cache

import numpy as np

from ....arrays import LinkParameters, SquareMatrix
from ....estimate.body import nearest_body
from ....robot.parameters import INERTIAL_SYMBOLS

TENABLE, TENABLE_SHARE = 30.0, 0.03
"""Squared distance from a body, in deviations, that luck or a share of the whole effect accounts for."""
MASS = INERTIAL_SYMBOLS.index("M")


def body_of(values: LinkParameters, covariance: SquareMatrix) -> tuple[LinkParameters, float]:
    """Give the nearest body, or minus one where the mass is negative, and its squared distance."""
    return _known(values.tobytes(), covariance.tobytes())


def is_body(values: LinkParameters, covariance: SquareMatrix) -> bool:
    """Tell whether a body, or minus one, is a tenable reading of the parameters.

    Its mass has to be told from none: ten free numbers that weigh nothing are no body.
    """
    if abs(values[MASS]) < 2.0 * np.sqrt(max(float(covariance[MASS, MASS]), 0.0)):
        return False
    deviation = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    unit = values / deviation
    whole = float(unit @ np.linalg.lstsq(covariance / np.outer(deviation, deviation), unit, rcond=1e-10)[0])
    return body_of(values, covariance)[1] < max(TENABLE, TENABLE_SHARE * whole)


@lru_cache(maxsize=64)
def _known(values: bytes, covariance: bytes) -> tuple[LinkParameters, float]:
    """Solve once for what several questions ask of the same fit."""
    ten = np.frombuffer(values)
    return nearest_body(ten, np.frombuffer(covariance).reshape(10, 10), removed=bool(ten[MASS] < 0.0))
