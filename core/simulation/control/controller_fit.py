"""Fit the gains of one joint's controller by least squares.

A table holds the errors of position and speed, the integrals of both where the controller integrates, and
last the command. Its QR triangle says the same. A command is linear in the gains, but for the position gain
of a cascade that integrates, which is searched.
"""

from collections.abc import Callable, Mapping
from typing import Final

import numpy as np
from scipy.optimize import least_squares

from ...arrays import EquationRows, Parameters, Vector
from .controller import Kind
from .declared import Known

_RANK: Final = 1e-7
"""Columns of length one depend on each other where a singular value is this share of the largest."""

Gains = tuple[float, float, float]
"""kp, kd and ki of one joint."""


def left_by(kind: Kind, gains: Gains, table: EquationRows) -> float:
    """Give the norm of what gains leave of the command."""
    columns = table[:, :-1]
    return float(np.linalg.norm(table[:, -1] - columns @ _answers(kind, gains)[: columns.shape[1]]))


def _answers(kind: Kind, gains: Gains | Vector) -> Vector:
    """Give what the command answers the errors of position and speed with, and their integrals."""
    kp, kd, ki = gains
    return np.array((kp * kd, kd, kp * ki, ki) if kind == "cascade" else (kp, kd, ki, 0.0))


def _fit_pd(columns: EquationRows, target: Vector) -> Gains | None:
    """Fit kp e + kd s, and ki times the integral of e where there are integrals."""
    found = _solved(columns[:, :3], target)
    return None if found is None else (float(found[0]), float(found[1]), float([*found, 0.0][2]))


def _fit_cascade(columns: EquationRows, target: Vector) -> Gains | None:
    """Fit kv (kp e + s), and ki times the integral of kp e + s where there are integrals."""
    found = _solved(columns, target)
    if found is None or found[1] <= 0.0 or found[0] <= 0.0:
        return None
    kp = float(found[0] / found[1])
    if columns.shape[1] == 2:
        return kp, float(found[1]), 0.0

    def missed(gains: Vector) -> Vector:
        return np.asarray(target - columns @ _answers("cascade", gains))

    kp, kv, ki = least_squares(missed, (kp, found[1], found[3]), method="lm", x_scale="jac").x
    return float(kp), float(kv), float(ki)


_FITS: Final[Mapping[Kind, Callable[[EquationRows, Vector], Gains | None]]] = {
    "pd": _fit_pd,
    "cascade": _fit_cascade,
}


def fitted_gains(kind: Kind, columns: EquationRows, target: Vector, known: Known) -> Gains | None:
    """Fit those gains of one joint that are not known; None where they cannot be determined."""
    used = known if columns.shape[1] > 2 else known[:2]
    free = [place for place, value in enumerate(used) if value is None]
    if len(free) == len(used):
        return _FITS[kind](columns, target)
    fixed = np.array([value or 0.0 for value in known])
    return _fitted_beside(kind, columns, target, fixed, free) if free else _gains(fixed)


def _fitted_beside(
    kind: Kind, columns: EquationRows, target: Vector, fixed: Vector, free: list[int]
) -> Gains | None:
    """Fit some gains beside others that are known."""

    def at(values: Vector) -> Vector:
        gains = fixed.copy()
        gains[free] = values
        return gains

    def missed(values: Vector) -> Vector:
        return np.asarray(target - columns @ _answers(kind, at(values))[: columns.shape[1]])

    begun = _FITS[kind](columns, target) or (1.0, 1.0, 1.0)
    found = least_squares(missed, np.array(begun)[free], method="lm", x_scale="jac")
    slopes = np.asarray(found.jac)
    sizes = np.linalg.norm(slopes, axis=0)
    if not np.all(sizes > 0.0) or np.linalg.matrix_rank(slopes / sizes, tol=_RANK) < len(free):
        return None
    return _gains(at(found.x))


def _gains(values: Vector) -> Gains:
    kp, kd, ki = values.tolist()
    return kp, kd, ki


def _solved(columns: EquationRows, target: Vector) -> Parameters | None:
    """Solve least squares; None where a column depends on the others."""
    sizes = np.linalg.norm(columns, axis=0)
    if not np.all(sizes > 0.0):
        return None
    found, _, rank, _ = np.linalg.lstsq(columns / sizes, target, rcond=_RANK)
    return None if rank < len(sizes) else np.asarray(found / sizes)
