"""Fit a model to the rows of a look under coloured noise, and say how likely the rows are under it.

Generalised least squares: per joint the rows are whitened by the joint's own autoregression, which is learned
again from the residual of every hypothesis; a noise model kept from another hypothesis would have learned the
effect in question as noise. Sources: Aitken 1936; Cochrane & Orcutt 1949; Brunot et al., Control Eng. Pract.
74, 2018.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from core.arrays import Indices, Matrix, SquareMatrix, Vector
from core.diagnosis.look import Look
from core.diagnosis.noise import JointNoise, learn_noise, places

RIDGE = 1e-10
"""Share of a column's own square that keeps directions which the motion leaves open from blowing up."""
ROUNDS = 2

Columns = Mapping[int, Matrix]
"""Per joint (from 0), rows x columns; a joint that is left out has zeros."""


@dataclass(frozen=True, eq=False)
class JointRows:
    """Hold the rows of one joint that a fit may use: columns, torque and their places within runs."""

    rows: Indices
    place: Indices
    columns: Matrix
    torque: Vector


@dataclass(frozen=True, eq=False)
class Whitened:
    """Hold one joint's rows made white: columns and torque in units of the noise."""

    noise: JointNoise
    columns: Matrix
    torque: Vector
    log_deviations: float


@dataclass(frozen=True, eq=False)
class Fit:
    """Hold a generalised least-squares fit.

    Attributes
    ----------
    joints
        The whitened rows per joint.
    values
        Coefficient of every column.
    factor
        Cholesky factor of the columns' Gram matrix, scaled by `scale`.
    log_likelihood
        Of the rows, noise model included.
    """

    joints: tuple[Whitened, ...]
    values: Vector
    factor: tuple[np.ndarray, bool]
    scale: Vector
    log_likelihood: float

    def solve(self, right: Matrix) -> Matrix:
        """Give Gram^-1 times right-hand sides."""
        return np.asarray(cho_solve(self.factor, right / self.scale[:, None]) / self.scale[:, None])

    @property
    def covariance(self) -> SquareMatrix:
        """Give the coefficients' covariance."""
        return self.solve(np.eye(len(self.values)))


def joint_rows(look: Look, columns: Sequence[Matrix], mask: np.ndarray) -> tuple[JointRows, ...]:
    """Take, per joint, the rows that a mask (rows x joints) allows."""
    out = []
    for joint in range(look.joints):
        rows = np.flatnonzero(mask[:, joint])
        follows = np.diff(rows, prepend=-2) == 1
        follows &= ~look.starts[rows]
        out.append(JointRows(rows, places(follows), columns[joint][rows], look.torque[rows, joint]))
    return tuple(out)


def extended(joints: tuple[JointRows, ...], columns: Sequence[Columns]) -> tuple[JointRows, ...]:
    """Append further columns, given over all rows of the look."""
    widths = [next(iter(one.values())).shape[1] for one in columns]
    out = []
    for joint, rows in enumerate(joints):
        parts = [rows.columns]
        for one, width in zip(columns, widths, strict=True):
            parts.append(one[joint][rows.rows] if joint in one else np.zeros((len(rows.rows), width)))
        out.append(JointRows(rows.rows, rows.place, np.hstack(parts), rows.torque))
    return tuple(out)


def whitened(rows: JointRows, noise: JointNoise) -> Whitened:
    """Whiten one joint's rows."""
    both = noise.whitened(np.column_stack([rows.columns, rows.torque]), rows.place)
    return Whitened(noise, both[:, :-1], both[:, -1], noise.log_deviations(rows.place))


def fit(
    joints: tuple[JointRows, ...], noise: tuple[JointNoise, ...] | None = None, *, rounds: int = ROUNDS
) -> Fit:
    """Fit all columns to all joints' rows, learning the noise anew in every round.

    Parameters
    ----------
    noise
        What to begin with; None to begin with white noise of the torque's size.
    """
    if noise is None:
        noise = tuple(learn_noise(rows.torque, rows.place, order=0) for rows in joints)
        rounds += 1
    found = _solved(tuple(whitened(rows, one) for rows, one in zip(joints, noise, strict=True)))
    for _ in range(rounds):
        noise = tuple(learn_noise(rows.torque - rows.columns @ found.values, rows.place) for rows in joints)
        found = _solved(tuple(whitened(rows, one) for rows, one in zip(joints, noise, strict=True)))
    return found


def _solved(joints: tuple[Whitened, ...]) -> Fit:
    gram = sum(one.columns.T @ one.columns for one in joints)
    right = sum(one.columns.T @ one.torque for one in joints)
    scale = np.sqrt(np.maximum(np.diag(gram), 1e-300))
    scaled = gram / np.outer(scale, scale) + RIDGE * np.eye(len(gram))
    factor = cho_factor(scaled, lower=True)
    values = cho_solve(factor, right / scale) / scale
    missed = sum(float(np.sum((one.torque - one.columns @ values) ** 2)) for one in joints)
    logs = sum(one.log_deviations for one in joints)
    return Fit(joints, values, factor, scale, -0.5 * missed - logs)
