"""Test whether ten fitted parameters may be those of a body that was added or removed."""

from functools import lru_cache

import numpy as np

from ....arrays import LinkParameters, SquareMatrix
from ....estimate.body import nearest_body
from ....robot.model import INERTIAL_SYMBOLS
from ...thresholds.causes import ADMISSIBLE

MASS = INERTIAL_SYMBOLS.index("M")


def body_of(values: LinkParameters, covariance: SquareMatrix) -> tuple[LinkParameters, float]:
    """Give the nearest body, or minus one where the mass is negative, and its squared distance."""
    return _nearest(values.tobytes(), covariance.tobytes())


def is_body(values: LinkParameters, covariance: SquareMatrix) -> bool:
    """Tell whether the parameters may be those of a body, or minus one.

    Its mass has to differ significantly from zero: ten free numbers without mass are no body.
    """
    if abs(values[MASS]) < ADMISSIBLE.significant * np.sqrt(max(float(covariance[MASS, MASS]), 0.0)):
        return False
    deviation = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    unit = values / deviation
    whole = float(unit @ np.linalg.lstsq(covariance / np.outer(deviation, deviation), unit, rcond=1e-10)[0])
    return body_of(values, covariance)[1] < max(ADMISSIBLE.body_distance, ADMISSIBLE.body_share * whole)


@lru_cache(maxsize=64)
def _nearest(values: bytes, covariance: bytes) -> tuple[LinkParameters, float]:
    """Solve once per fit."""
    ten = np.frombuffer(values)
    return nearest_body(ten, np.frombuffer(covariance).reshape(10, 10), removed=bool(ten[MASS] < 0.0))
