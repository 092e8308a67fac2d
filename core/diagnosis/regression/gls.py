"""Fit columns to the rows of a data set by generalised least squares under AR noise, iterated.

Per joint the rows are prewhitened by the joint's own autoregression, which is estimated again from the
residual of every hypothesis. A noise model of another hypothesis would have absorbed the effect in question.
A fit under coloured noise may leave slow torque to the noise, and noise estimated from that residual absorbs
more of it. Where that goes too far, noise is estimated from the residual of ordinary least squares.
Sources: Aitken 1936; Cochrane & Orcutt 1949; Amemiya, Advanced Econometrics (1985), ch. 6, on one step from
ordinary residuals; Brunot et al., Control Eng. Pract. 74, 2018.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import cho_factor
from scipy.linalg.lapack import dpotrs

from ...arrays import JointVector, Mask, Matrix, SquareMatrix, Vector, Weights
from ...estimate.gaussian_prior import GaussianPrior
from ..thresholds.regression import COLUMNS, NOISE
from .ar_noise import ARNoise, fit_ar_noise
from .prewhitening import Prewhitened, prewhiten
from .rows import JointRows

RIDGE = 1e-10
"""Share of a column's own square that bounds directions that the motion does not determine."""
STEPS, EXACT = 5, 1e-6
"""Steps of a solution at most, until another would add less than this to twice the likelihood."""


@dataclass(frozen=True, eq=False)
class Fit:
    """Hold a generalised least-squares fit."""

    joints: tuple[Prewhitened, ...]
    """The prewhitened rows per joint."""
    left: tuple[Weights, ...]
    """Their residual, white."""
    values: Vector
    """Coefficient of every column."""
    factor: SquareMatrix
    """Lower Cholesky factor of the columns' Gram matrix, scaled by `scale`."""
    scale: Vector
    shown: Mask
    """Columns that hold more than rounding; the others have no coefficient."""
    by_joint: JointVector
    """Log-likelihood of every joint's rows, noise model included."""
    prior: GaussianPrior | None = None
    """Normal prior of the first columns' coefficients; None for none."""
    plain: "Fit | None" = None
    """The ordinary fit from whose residual noise is estimated; None where it is estimated from this one's."""

    @cached_property
    def log_likelihood(self) -> float:
        """Give the log-likelihood of all rows and of the prior."""
        departed = 0.0 if self.prior is None else self.prior.departure(self.values)
        return float(self.by_joint.sum()) - 0.5 * departed

    def solve(self, right: Matrix) -> Matrix:
        """Give Gram^-1 times right-hand sides."""
        return _solve_scaled(self.factor, self.scale[:, None], right)

    @cached_property
    def covariance(self) -> SquareMatrix:
        """Give the coefficients' covariance."""
        return self.solve(np.eye(len(self.values)))


def fit(
    joints: tuple[JointRows, ...],
    noise: tuple[ARNoise, ...] | None = None,
    *,
    rounds: int = NOISE.rounds,
    prior: GaussianPrior | None = None,
    ordinary: bool = False,
) -> Fit:
    """Fit all columns to all joints' rows, estimating the noise again in every round.

    Parameters
    ----------
    noise
        The noise of the first round; None for white noise of the torque's size.
    prior
        Normal prior of the first columns' coefficients.
    ordinary
        Whether noise is estimated from the residual of an ordinary fit.
    """
    size = _size(joints)
    if noise is not None:
        return _iterate(joints, _solve(_prewhiten(joints, noise), size, prior), None, rounds)
    if ordinary:
        plain = _fit_ordinary(joints, prior)
        return _iterate(joints, replace(plain, plain=plain), None, rounds + 1)
    first = _white_noise(joints, [rows.torque for rows in joints])
    return _iterate(joints, _solve(_prewhiten(joints, first), size, prior), None, rounds + 1)


def noise_absorbs_effect(joints: tuple[JointRows, ...], found: Fit) -> bool:
    """Tell whether a fit leaves much more residual on some joint than an ordinary fit does."""
    plain = _fit_ordinary(joints, found.prior)
    pairs = zip(_residuals(joints, found), _residuals(joints, plain), strict=True)
    return any(float(ours @ ours) > NOISE.absorbed**2 * float(theirs @ theirs) for ours, theirs in pairs)


def _fit_ordinary(joints: tuple[JointRows, ...], prior: GaussianPrior | None) -> Fit:
    """Fit by ordinary least squares, with each joint weighted by its residual."""
    size = _size(joints)
    first = _solve(_prewhiten(joints, _white_noise(joints, [rows.torque for rows in joints])), size, prior)
    return _solve(_prewhiten(joints, _white_noise(joints, _residuals(joints, first))), size, prior)


def _white_noise(joints: tuple[JointRows, ...], sized: Iterable[Weights]) -> tuple[ARNoise, ...]:
    return tuple(fit_ar_noise(left, rows.run_index, 0) for left, rows in zip(sized, joints, strict=True))


def _size(joints: tuple[JointRows, ...]) -> int:
    return joints[0].size


def _residuals(joints: tuple[JointRows, ...], found: Fit) -> list[Weights]:
    return [part.residual(rows, found.values) for part, rows in zip(found.joints, joints, strict=True)]


def _prewhiten(joints: tuple[JointRows, ...], noise: tuple[ARNoise, ...]) -> tuple[Prewhitened, ...]:
    return tuple(prewhiten(rows, model) for rows, model in zip(joints, noise, strict=True))


def refit(
    joints: tuple[JointRows, ...],
    before: Fit,
    kept: int,
    touched: frozenset[int] | None = None,
    *,
    rounds: int = NOISE.rounds,
) -> Fit:
    """Fit the same rows to other columns, estimating the noise again from that of another fit.

    Parameters
    ----------
    kept
        How many of the first columns are those of the fit before.
    touched
        Joints (from 0) whose noise is estimated again; None for all.
    """
    parts = tuple(old.with_columns(kept, rows) for old, rows in zip(before.joints, joints, strict=True))
    plain = None if before.plain is None else refit(joints, before.plain, kept, rounds=0)
    return _iterate(joints, _solve(parts, _size(joints), before.prior, plain), touched, rounds)


def _iterate(joints: tuple[JointRows, ...], found: Fit, touched: frozenset[int] | None, rounds: int) -> Fit:
    """Estimate the noise of some or all joints again until the likelihood hardly rises."""
    for _ in range(rounds):
        before, found = found, _reestimate_noise(joints, found, touched)
        if found is before:
            break
    return found


def _reestimate_noise(joints: tuple[JointRows, ...], found: Fit, touched: frozenset[int] | None) -> Fit:
    """Estimate the noise of some or all joints from their residual; fit again where it changed."""
    parts, seen = list(found.joints), found.plain or found
    for joint in range(len(joints)) if touched is None else touched:
        rows, known = joints[joint], found.joints[joint]
        residual = seen.joints[joint].residual(rows, seen.values)
        estimated = fit_ar_noise(residual, rows.run_index, taken=degrees_of_freedom(rows, joints))
        if estimated.departure(known.noise, residual, rows.run_index) > NOISE.settled:
            parts[joint] = prewhiten(rows, estimated)
    if tuple(parts) == found.joints:
        return found
    return _solve(tuple(parts), _size(joints), found.prior, found.plain)


def degrees_of_freedom(rows: JointRows, joints: tuple[JointRows, ...]) -> float:
    """Count a fit's degrees of freedom on one joint's rows: nuisance columns and a share of the others."""
    total = sum(len(joint.rows) for joint in joints)
    return float(rows.nuisance.count + rows.size * len(rows.rows) / max(total, 1))


def _gram(joints: tuple[Prewhitened, ...], size: int, prior: GaussianPrior | None) -> np.ndarray:
    gram = np.zeros((size, size))
    for joint in joints:
        gram[np.ix_(joint.acting, joint.acting)] += joint.gram
    if prior is not None:
        known = prior.rows.shape[1]
        gram[:known, :known] += prior.rows.T @ prior.rows
    return gram


def _solve(
    joints: tuple[Prewhitened, ...], size: int, prior: GaussianPrior | None, plain: Fit | None = None
) -> Fit:
    """Solve the normal equations with iterative refinement: the ridge and rounding bias one step."""
    gram = _gram(joints, size, prior)
    shown = np.diag(gram) > COLUMNS.least_size**2  # where joints stand, a column may hold rounding alone
    gram *= np.outer(shown, shown)
    scale = np.sqrt(np.where(shown, np.diag(gram), 1.0))
    scaled = gram / np.outer(scale, scale) + RIDGE * np.eye(len(gram))
    factor, _ = cho_factor(scaled, lower=True)
    values = np.zeros(len(gram))
    left = tuple(part.torque for part in joints)
    for _ in range(STEPS):
        slope = np.zeros(size)
        for part, rest in zip(joints, left, strict=True):
            slope[part.acting] += part.columns.T @ rest
        if prior is not None:
            slope += prior.slope(values)
        step = _solve_scaled(factor, scale, slope * shown)
        if float(slope @ step) < EXACT:
            break
        values = values + step
        left = tuple(part.left(values) for part in joints)
    by_joint = np.array(
        [-0.5 * float(rest @ rest) - part.log_deviations for part, rest in zip(joints, left, strict=True)]
    )
    return Fit(joints, left, values, factor, scale, shown, by_joint, prior, plain)


def _solve_scaled(factor: SquareMatrix, scale: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solve the equations of a scaled Gram matrix, of which the lower factor is given."""
    solved, _ = dpotrs(factor, right / scale, lower=1)
    return np.asarray(solved / scale)
