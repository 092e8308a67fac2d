"""Weight and stack the joints' factors into one small least-squares problem over the base parameters.

Joints differ in noise by orders of magnitude, so the default weighs each joint by its own residual, as the
IDIM-LS practice does. Source: Gautier 1997; Khalil & Dombre (2002), ch. 12.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BaseParameters, Indices, JointVector, Matrix, Vector
from ..errors import ExcitationError
from ..regressor.factor import Factor
from .gaussian_prior import GaussianPrior

RANK_TOLERANCE = 1e-8
ROUNDING = 1e-12
"""A column smaller than this share of the largest is what differences leave of a motion that is not there."""
_REWEIGHTINGS = 2


@dataclass(frozen=True, eq=False)
class System:
    """Hold min ||target - triangle base||^2 + rest, weighted."""

    triangle: Matrix
    target: Vector
    """The stacked factor over all base columns."""
    rest: float
    """What no parameters can explain, weighted."""
    rows: int
    """Number of equations it stands for."""
    noise: JointVector
    """Standard deviation per joint that the rows were divided by, N m; ones for an unweighted fit."""

    def cost(self, base: BaseParameters) -> float:
        """Give the weighted sum of squared residuals."""
        miss = self.target - self.triangle @ base
        return float(miss @ miss) + self.rest

    def with_prior(self, prior: GaussianPrior | None) -> "System":
        """Add the equations of a prior of the first base parameters, where there is one.

        Examples
        --------
        One that weighs as much as the log's own meets it half-way:

        >>> own = System(np.eye(1), np.array([1.0]), 0.0, 10, np.ones(1))
        >>> own.with_prior(GaussianPrior(np.eye(1), np.array([3.0]))).solved().round(12)
        array([2.])
        """
        if prior is None:
            return self
        size = self.triangle.shape[1]
        wide = np.zeros((len(prior.rows) + 1, size + 1))
        wide[:-1, : prior.rows.shape[1]], wide[:-1, -1] = prior.rows, prior.target
        whole = Factor.of(np.vstack([np.column_stack([self.triangle, self.target]), wide])).triangle
        rest = whole[size:, -1]
        return replace(
            self, triangle=whole[:size, :-1], target=whole[:size, -1], rest=self.rest + float(rest @ rest)
        )

    def solved(self) -> BaseParameters:
        """Give the unconstrained optimum of smallest norm, should the motion leave directions open."""
        scale = column_scale(self.triangle)
        scaled, *_ = np.linalg.lstsq(self.triangle / scale, self.target, rcond=RANK_TOLERANCE)
        return np.asarray(scaled / scale)


def stacked(
    factors: tuple[Factor, ...], columns_of: tuple[Indices, ...], base: int, noise: JointVector
) -> System:
    """Stack the joints' factors, each divided by its noise."""
    rows = [
        _widened(factor, columns, base) / sigma
        for factor, columns, sigma in zip(factors, columns_of, noise, strict=True)
    ]
    rows.append(np.zeros((base + 2, base + 1)))  # so that few rows are made triangular and square too
    whole = Factor.of(np.vstack(rows)).triangle
    inner = whole[:base]
    rest = whole[base:, -1]
    return System(
        triangle=_zero_unexcited(inner[:, :-1]),
        target=inner[:, -1],
        rest=float(rest @ rest),
        rows=sum(factor.rows for factor in factors),
        noise=noise,
    )


def ordinary(factors: tuple[Factor, ...], columns_of: tuple[Indices, ...], base: int) -> System:
    """Stack without weights.

    Raises
    ------
    ExcitationError
        If there are fewer usable equations than parameters.
    """
    rows = sum(factor.rows for factor in factors)
    if rows <= base:
        raise ExcitationError(
            "the log has fewer usable equations than the model has parameters",
            evidence={"equations": rows, "parameters": base},
            remedy="record a longer motion, or keep more samples with a smaller decimation",
        )
    return stacked(factors, columns_of, base, np.ones(len(factors)))


def weighted(factors: tuple[Factor, ...], columns_of: tuple[Indices, ...], base: int) -> System:
    """Stack with each joint divided by the RMS of its own residual, in two rounds from the unweighted fit."""
    system = ordinary(factors, columns_of, base)
    for _ in range(_REWEIGHTINGS):
        system = stacked(factors, columns_of, base, joint_noise(factors, columns_of, system.solved()))
    return system


def joint_noise(
    factors: tuple[Factor, ...], columns_of: tuple[Indices, ...], base: BaseParameters
) -> JointVector:
    """Give the RMS residual per joint, N m; the parameters count against all joints' equations alike."""
    rows = sum(factor.rows for factor in factors)
    share = max(1.0 - len(base) / rows, 1.0 / rows)
    squares = [
        factor.residual_square(base[columns]) for factor, columns in zip(factors, columns_of, strict=True)
    ]
    torque = [factor.torque_square for factor in factors]
    floors = [max(1e-12 * square, 1e-24) for square in torque]
    return np.array(
        [
            np.sqrt(max(square, floor) / max(share * factor.rows, 1.0))
            for square, floor, factor in zip(squares, floors, factors, strict=True)
        ]
    )


def column_scale(matrix: Matrix) -> Vector:
    """Give the norm of every column, one where it is zero."""
    norms = np.linalg.norm(matrix, axis=0)
    return np.where(norms > 0.0, norms, 1.0)


def _zero_unexcited(columns: Matrix) -> Matrix:
    """Set columns to zero that are nothing but rounding beside the largest.

    Examples
    --------
    >>> _zero_unexcited(np.array([[3.0, 1e-15], [4.0, 1e-15]]))
    array([[3., 0.],
           [4., 0.]])
    """
    norms = np.linalg.norm(columns, axis=0)
    return np.where(norms > ROUNDING * norms.max(initial=0.0), columns, 0.0)


def _widened(factor: Factor, columns: Indices, base: int) -> Matrix:
    wide = np.zeros((len(factor.triangle), base + 1))
    wide[:, columns] = factor.triangle[:, :-1]
    wide[:, -1] = factor.triangle[:, -1]
    return wide
