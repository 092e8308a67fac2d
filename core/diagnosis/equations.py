"""Fit a model to the rows of a look under coloured noise, and say how likely the rows are under it.

Generalised least squares: per joint the rows are whitened by the joint's own autoregression, which is learned
again from the residual of every hypothesis; a noise model kept from another hypothesis would have learned the
effect in question as noise. Sources: Aitken 1936; Cochrane & Orcutt 1949; Brunot et al., Control Eng. Pract.
74, 2018.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse import csr_array
from scipy.sparse.linalg import spsolve_triangular

from core.arrays import EquationRows, Indices, Matrix, SquareMatrix, Vector, Weights
from core.diagnosis.free import Free, free_of, independent
from core.diagnosis.look import Look
from core.diagnosis.noise import JointNoise, learn_noise, places

RIDGE = 1e-10
"""Share of a column's own square that keeps directions which the motion leaves open from blowing up."""
ROUNDS = 3
TRIAL_ROUNDS = 2
SETTLED = 0.1
"""Change of the log-likelihood below which the noise is learned: what decides changes it by three or more."""

Columns = Mapping[int, EquationRows]
"""Per joint (from 0), rows x columns; a joint that is left out has zeros."""


@dataclass(frozen=True, eq=False)
class JointRows:
    """Hold the rows of one joint that a fit may use.

    Attributes
    ----------
    rows, place
        Which rows of the look, and their places within runs.
    columns, torque
        What is fitted to what.
    free
        Columns of any size: friction while the joint sticks.
    """

    rows: Indices
    place: Indices
    columns: Matrix
    torque: Vector
    free: Free

    def missed(self, values: Weights) -> Vector:
        """Give what the columns leave over, less what the free ones take."""
        left = self.torque - self.columns @ values
        return self.free.cleared(left[:, None])[:, 0]

    def missed_under(self, values: Weights, white: "Whitened") -> Vector:
        """Give the same, what the free columns take being judged under a noise and not row by row."""
        left = white.whitening @ (self.torque - self.columns @ values)
        cleared = white.free.cleared(left[:, None])[:, 0]
        return np.asarray(spsolve_triangular(white.whitening, cleared, lower=True))


@dataclass(frozen=True, eq=False)
class Whitened:
    """Hold one joint's rows made white: columns and torque in units of the noise.

    `whitening` is what does that, before `free` columns are taken out.
    """

    noise: JointNoise
    whitening: csr_array
    columns: Matrix
    torque: Vector
    log_deviations: float
    free: Free

    @cached_property
    def gram(self) -> SquareMatrix:
        """Give the columns' products with each other."""
        out = np.zeros((self.columns.shape[1], self.columns.shape[1]))
        acting = np.flatnonzero(self.columns.any(axis=0))
        columns = self.columns[:, acting]
        out[np.ix_(acting, acting)] = columns.T @ columns
        return out


@dataclass(frozen=True, eq=False)
class Belief:
    """Hold what is believed of the first columns' coefficients: white equations ``rows @ values = target``."""

    rows: Matrix
    target: Vector

    def missed(self, values: Weights) -> Vector:
        """Give by how much coefficients depart from it, in standard deviations."""
        return self.target - self.rows @ values[: self.rows.shape[1]]


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
        Of the rows, noise model included, and of what was believed.
    belief
        What was believed beforehand; None where nothing was.
    """

    joints: tuple[Whitened, ...]
    values: Vector
    factor: tuple[np.ndarray, bool]
    scale: Vector
    log_likelihood: float
    belief: Belief | None = None

    @cached_property
    def left(self) -> tuple[Weights, ...]:
        """Give, per joint, what the columns leave of the torque, white."""
        return tuple(one.torque - one.columns @ self.values for one in self.joints)

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
        out.append(
            JointRows(
                rows,
                places(follows),
                columns[joint][rows],
                look.torque[rows, joint],
                free_of(independent(look.sticking[joint][rows])),
            )
        )
    return tuple(out)


def extended(joints: tuple[JointRows, ...], columns: Sequence[Columns]) -> tuple[JointRows, ...]:
    """Append further columns, given over all rows of the look."""
    widths = [next(iter(one.values())).shape[1] for one in columns]
    out = []
    for joint, rows in enumerate(joints):
        parts = [rows.columns]
        for one, width in zip(columns, widths, strict=True):
            parts.append(one[joint][rows.rows] if joint in one else np.zeros((len(rows.rows), width)))
        out.append(replace(rows, columns=np.hstack(parts)))
    return tuple(out)


def whitened(rows: JointRows, noise: JointNoise) -> Whitened:
    """Whiten one joint's rows."""
    whitening = noise.whitening(rows.place)
    free = free_of(whitening @ rows.free.columns)
    acting = np.flatnonzero(rows.columns.any(axis=0))
    both = free.cleared(whitening @ np.column_stack([rows.columns[:, acting], rows.torque]))
    columns = np.zeros_like(rows.columns)
    columns[:, acting] = both[:, :-1]
    return Whitened(noise, whitening, columns, both[:, -1], noise.log_deviations(rows.place), free)


def fit(
    joints: tuple[JointRows, ...],
    noise: tuple[JointNoise, ...] | None = None,
    *,
    rounds: int = ROUNDS,
    belief: Belief | None = None,
) -> Fit:
    """Fit all columns to all joints' rows, learning the noise anew in every round.

    Parameters
    ----------
    noise
        What to begin with; None to begin with white noise of the torque's size.
    belief
        What is believed of the first columns' coefficients beforehand.
    """
    if noise is None:
        noise = tuple(learn_noise(rows.torque, rows.place, order=0) for rows in joints)
        rounds += 1
    found = _solved(tuple(whitened(rows, one) for rows, one in zip(joints, noise, strict=True)), belief)
    everywhere = frozenset(range(len(joints)))
    return _settled(joints, found, everywhere, rounds)


def refit(
    joints: tuple[JointRows, ...], before: Fit, touched: frozenset[int], *, rounds: int = TRIAL_ROUNDS
) -> Fit:
    """Fit joints that got further columns, learning the noise anew only where these columns act.

    Parameters
    ----------
    before
        A fit of the same rows without the further columns, which stand last.
    touched
        Joints (from 0) on which they act.
    """
    parts = []
    for joint, rows in enumerate(joints):
        old = before.joints[joint]
        new = rows.columns[:, old.columns.shape[1] :]
        white = old.free.cleared(old.whitening @ new) if joint in touched else np.zeros_like(new)
        parts.append(replace(old, columns=np.hstack([old.columns, white])))
    found = _solved(tuple(parts), before.belief)
    return _settled(joints, found, touched, rounds)


def _settled(joints: tuple[JointRows, ...], found: Fit, touched: frozenset[int], rounds: int) -> Fit:
    """Learn the noise of some joints again and again, until that hardly makes the rows more likely."""
    for _ in range(rounds):
        before, found = found, _relearned(joints, found, touched)
        if abs(found.log_likelihood - before.log_likelihood) < SETTLED:
            break
    return found


def _relearned(joints: tuple[JointRows, ...], found: Fit, touched: frozenset[int]) -> Fit:
    """Learn the noise of some joints from their residual, and fit again."""
    parts = list(found.joints)
    for joint in touched:
        rows = joints[joint]
        parts[joint] = whitened(
            rows,
            learn_noise(
                rows.missed_under(found.values, found.joints[joint]), rows.place, taken=_taken(rows, joints)
            ),
        )
    return _solved(tuple(parts), found.belief)


def _taken(rows: JointRows, joints: tuple[JointRows, ...]) -> float:
    """Count the degrees of freedom that a fit took from one joint's rows: its own and a share of the rest."""
    total = sum(len(one.rows) for one in joints)
    return float(rows.free.count + rows.columns.shape[1] * len(rows.rows) / max(total, 1))


def _solved(joints: tuple[Whitened, ...], belief: Belief | None) -> Fit:
    gram = np.sum([one.gram for one in joints], axis=0)
    right = np.sum([one.columns.T @ one.torque for one in joints], axis=0)
    if belief is not None:
        size = belief.rows.shape[1]
        gram[:size, :size] += belief.rows.T @ belief.rows
        right[:size] += belief.rows.T @ belief.target
    scale = np.sqrt(np.where(np.diag(gram) > 0.0, np.diag(gram), 1.0))
    scaled = gram / np.outer(scale, scale) + RIDGE * np.eye(len(gram))
    factor = cho_factor(scaled, lower=True)
    values = cho_solve(factor, right / scale) / scale
    missed = sum(float(np.sum((one.torque - one.columns @ values) ** 2)) for one in joints)
    if belief is not None:
        missed += float(np.sum(belief.missed(values) ** 2))
    logs = sum(one.log_deviations for one in joints)
    return Fit(joints, values, factor, scale, -0.5 * missed - logs, belief)
