"""Weight and stack the joints' factors into one small least-squares problem over the base parameters.

Joints differ in noise by orders of magnitude, so the default weighs each joint by its own residual, as the
IDIM-LS practice does. Source: Gautier 1997; Khalil & Dombre (2002), ch. 12.
"""

from dataclasses import dataclass, field, replace
from typing import Protocol, runtime_checkable

import numpy as np

from ..arrays import BaseParameters, Indices, JointVector, Matrix, Vector
from ..errors import ExcitationError
from ..regressor.factor import Factor
from .gaussian_prior import GaussianPrior

RANK_TOLERANCE = 1e-8
ROUNDING = 1e-12
"""A column smaller than this share of the largest is what differences leave of a motion that is not there."""
REWEIGHTINGS = 2


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
    criterion: "Criterion" = field(default_factory=lambda: LEAST_SQUARES)
    """How the rows of all joints became these equations."""
    carried: Matrix | None = None
    """Turns products with the instruments' rows into products with these equations; None where they are the
    log's own."""

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
        return np.asarray(solved_by(self.triangle, self.target[:, None])[:, 0])


@runtime_checkable
class Criterion(Protocol):
    """Say what the joints' rows are, and how all of them together become equations."""

    def width(self, base: int) -> int:
        """Count the columns of all joints' rows together."""

    def place(self, columns: Indices, base: int) -> Indices:
        """Give the columns at which a joint's own stand among them."""

    def system(self, whole: Matrix, rows: int, noise: JointVector) -> System:
        """Write the equations of the triangular factor of all rows, square."""


@dataclass(frozen=True)
class LeastSquares:
    """Minimise ||y - W base|| over rows [W y]."""

    def width(self, base: int) -> int:
        """Count the columns of all joints' rows together."""
        return base + 1

    def place(self, columns: Indices, base: int) -> Indices:
        """Give the columns at which a joint's own stand among them."""
        return np.append(columns, base)

    def system(self, whole: Matrix, rows: int, noise: JointVector) -> System:
        """Write the equations of the triangular factor of all rows, square."""
        triangle, target = _zero_unexcited(whole[:-1, :-1]), whole[:-1, -1]
        return System(triangle, target, float(whole[-1, -1] ** 2), rows, noise)


@dataclass(frozen=True)
class Instrumental:
    """Solve Z'(y - W base) = 0 over rows [Z W y].

    As least squares it minimises the part of the residual that the instruments span, ||Rzw base - rzy||, the
    blocks being those of the rows' triangular factor. Source: Soderstrom & Stoica, Instrumental Variable
    Methods (1983).
    """

    def width(self, base: int) -> int:
        """Count the columns of all joints' rows together."""
        return 2 * base + 1

    def place(self, columns: Indices, base: int) -> Indices:
        """Give the columns at which a joint's own stand among them."""
        return np.concatenate([columns, base + columns, [2 * base]])

    def system(self, whole: Matrix, rows: int, noise: JointVector) -> System:
        """Write the equations of the triangular factor of all rows, square."""
        base = len(whole) // 2
        triangle, target = _zero_unexcited(whole[:base, base:-1]), whole[:base, -1]
        carried = solved_by(whole[:base, :base], triangle).T
        turned = np.asarray(np.linalg.qr(np.column_stack([triangle, target]), mode="r"))  # solvers like zeros
        system = System(turned[:, :-1], turned[:, -1], 0.0, rows, noise, criterion=self, carried=carried)
        left = whole[base:, -1] - whole[base:, base:-1] @ system.solved()
        return replace(system, rest=float(left @ left))


LEAST_SQUARES: Criterion = LeastSquares()
INSTRUMENTAL: Criterion = Instrumental()


def stacked(
    factors: tuple[Factor, ...],
    columns_of: tuple[Indices, ...],
    base: int,
    noise: JointVector,
    criterion: Criterion = LEAST_SQUARES,
) -> System:
    """Stack the joints' factors, each divided by its noise."""
    width = criterion.width(base)
    rows = list[Matrix]()
    for factor, columns, sigma in zip(factors, columns_of, noise, strict=True):
        wide = np.zeros((len(factor.triangle), width))
        wide[:, criterion.place(columns, base)] = factor.triangle / sigma
        rows.append(wide)
    rows.append(np.zeros((width + 1, width)))  # so that few rows are made triangular and square too
    whole = Factor.of(np.vstack(rows)).triangle
    return criterion.system(whole, sum(factor.rows for factor in factors), noise)


def ordinary(
    factors: tuple[Factor, ...],
    columns_of: tuple[Indices, ...],
    base: int,
    criterion: Criterion = LEAST_SQUARES,
) -> System:
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
    return stacked(factors, columns_of, base, np.ones(len(factors)), criterion)


def weighted(
    factors: tuple[Factor, ...],
    columns_of: tuple[Indices, ...],
    base: int,
    criterion: Criterion = LEAST_SQUARES,
) -> System:
    """Stack with each joint divided by the RMS of its own residual, in two rounds from the unweighted fit."""
    system = ordinary(factors, columns_of, base, criterion)
    for _ in range(REWEIGHTINGS):
        noise = joint_noise(factors, columns_of, system.solved())
        system = stacked(factors, columns_of, base, noise, criterion)
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


def solved_by(matrix: Matrix, right: np.ndarray) -> np.ndarray:
    """Solve matrix x = right, with the smallest x where columns of the matrix leave directions open.

    Examples
    --------
    >>> solved_by(np.array([[2.0, 1.0], [0.0, 4.0]]), np.array([[4.0], [8.0]])).round(12)
    array([[1.],
           [2.]])
    """
    scale = column_scale(matrix)
    solution, *_ = np.linalg.lstsq(matrix / scale, right, rcond=RANK_TOLERANCE)
    return np.asarray(solution / scale[:, None])


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
