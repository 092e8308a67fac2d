"""Condense equations: the triangular factor of a least-squares problem, which merges like a sum.

R of [W Y] holds all that least squares can know of its rows: R'R = [W Y]'[W Y]. Two factors merge by one more
triangularisation, so the statistic of a long log is the merged statistic of its parts, in any order. QR is
used rather than the normal equations because extended models are nearly collinear. Source: Golub & Van Loan,
Matrix Computations, ch. 5; Lawson & Hanson 1974, ch. 27.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Indices, Matrix, Parameters, Rows


@dataclass(frozen=True, eq=False)
class Factor:
    """Hold the triangular factor of rows [W y] and their number.

    Examples
    --------
    >>> part = Factor.of(np.array([[1.0, 2.0], [1.0, 4.0]]))
    >>> whole = part.merged(Factor.of(np.array([[1.0, 3.0]])))
    >>> whole.rows, float(abs(whole.triangle[0, 1] / whole.triangle[0, 0]).round(12))
    (3, 3.0)
    """

    triangle: Matrix
    rows: int

    @classmethod
    def empty(cls, columns: int) -> "Factor":
        """Start with no rows of [W y], `columns` in all."""
        return cls(np.zeros((0, columns)), 0)

    @classmethod
    def of(cls, rows: Matrix) -> "Factor":
        """Condense rows."""
        return cls.empty(rows.shape[1]).extended(rows)

    def extended(self, rows: Matrix) -> "Factor":
        """Take further rows in."""
        if not len(rows):
            return self
        return Factor(_triangle(np.vstack([self.triangle, rows])), self.rows + len(rows))

    def merged(self, other: "Factor") -> "Factor":
        """Join two factors over the same columns."""
        if not other.rows or not self.rows:
            return self if self.rows else other
        return Factor(_triangle(np.vstack([self.triangle, other.triangle])), self.rows + other.rows)

    def over(self, columns: Indices) -> "Factor":
        """Keep some of the columns; the last of those given is the torque's.

        Examples
        --------
        >>> rows = np.array([[1.0, 5.0, 2.0], [1.0, 7.0, 4.0], [1.0, 8.0, 9.0]])
        >>> fewer = np.array([0, 2])
        >>> part, alone = Factor.of(rows).over(fewer), Factor.of(rows[:, fewer])
        >>> bool(np.allclose(np.abs(part.triangle), np.abs(alone.triangle)))
        True
        """
        return Factor(_triangle(self.triangle[:, columns]), self.rows)

    def scaled(self, factor: float) -> "Factor":
        """Weight all rows by a number."""
        return Factor(self.triangle * factor, self.rows)

    def residual_square(self, parameters: Parameters) -> float:
        """Give ||y - W parameters||^2."""
        rest = self.triangle[:, -1] - self.triangle[:, :-1] @ parameters
        return float(rest @ rest)

    @property
    def torque_square(self) -> float:
        """Give ||y||^2."""
        return float(self.triangle[:, -1] @ self.triangle[:, -1])


def _triangle(rows: Rows) -> Rows:
    if len(rows) <= rows.shape[1]:
        return rows
    return np.asarray(np.linalg.qr(rows, mode="r"))
