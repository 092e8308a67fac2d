"""Condense equations: the triangular factor of a least-squares problem, which merges like a sum.

R of [W y] holds all that least squares can know of its rows: R'R = [W y]'[W y]. Two factors merge by one more
triangularisation, so the statistic of a long log is the merged statistic of its parts, in any order. Columns
come in named groups, so that other columns (instruments, say) stream through the same factor. QR is
used rather than the normal equations because extended models are nearly collinear. Source: Golub & Van Loan,
Matrix Computations, ch. 5; Lawson & Hanson 1974, ch. 27.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import EquationRows, Indices, Matrix, Parameters, Rows, UsableRows, Weights

FilteredRows = tuple[EquationRows, UsableRows]
"""One joint's filtered rows [w y] of a tile, and which of them may be used."""
Weigh = Callable[[list[FilteredRows]], list[Weights]]
"""Gives, per joint, the weights of a tile's rows."""
Groups = tuple[tuple[str, int], ...]
"""Names and widths of groups of columns, from left to right."""
INSTRUMENT, REGRESSOR, TARGET = "instrument", "regressor", "target"


@dataclass(frozen=True, eq=False)
class Factor:
    """Hold the triangular factor of rows, their number, and what their columns are: [W y] unless said.

    Examples
    --------
    >>> part = Factor.of(np.array([[1.0, 2.0], [1.0, 4.0]]))
    >>> whole = part.merged(Factor.of(np.array([[1.0, 3.0]])))
    >>> whole.rows, float(abs(whole.triangle[0, 1] / whole.triangle[0, 0]).round(12))
    (3, 3.0)
    """

    triangle: Matrix
    rows: int
    groups: Groups

    @classmethod
    def empty(cls, columns: int, groups: Groups | None = None) -> "Factor":
        """Start with no rows, of so many columns in all."""
        return cls(np.zeros((0, columns)), 0, groups or ((REGRESSOR, columns - 1), (TARGET, 1)))

    @classmethod
    def of(cls, rows: Matrix, groups: Groups | None = None) -> "Factor":
        """Condense rows."""
        return cls.empty(rows.shape[1], groups).extended(rows)

    def columns(self, name: str) -> Matrix:
        """Give the triangle's columns of one group.

        Examples
        --------
        >>> rows = np.array([[3.0, 5.0, 7.0], [4.0, 6.0, 8.0]])
        >>> three = Factor.of(rows, (("instrument", 1), ("regressor", 1), ("target", 1)))
        >>> three.columns("instrument")
        array([[3.],
               [4.]])
        """
        start = self._starts[name]
        return self.triangle[:, start : start + dict(self.groups)[name]]

    def extended(self, rows: Matrix) -> "Factor":
        """Take further rows in."""
        if not len(rows):
            return self
        return replace(self, triangle=_triangle(np.vstack([self.triangle, rows])), rows=self.rows + len(rows))

    def merged(self, *others: "Factor") -> "Factor":
        """Join factors over the same columns, all in one triangularisation."""
        known = [part for part in (self, *others) if part.rows]
        if len(known) < 2:
            return known[0] if known else self
        triangle = _triangle(np.vstack([part.triangle for part in known]))
        return replace(self, triangle=triangle, rows=sum(part.rows for part in known))

    def over(self, columns: Indices) -> "Factor":
        """Keep some of the columns, in their order.

        Examples
        --------
        >>> rows = np.array([[1.0, 5.0, 2.0], [1.0, 7.0, 4.0], [1.0, 8.0, 9.0]])
        >>> fewer = np.array([0, 2])
        >>> part, alone = Factor.of(rows).over(fewer), Factor.of(rows[:, fewer])
        >>> bool(np.allclose(np.abs(part.triangle), np.abs(alone.triangle)))
        True
        """
        groups = tuple(
            (name, int(np.count_nonzero((columns >= start) & (columns < start + width))))
            for (name, width), start in zip(self.groups, self._starts.values(), strict=True)
        )
        return Factor(_triangle(self.triangle[:, columns]), self.rows, groups)

    def scaled(self, factor: float) -> "Factor":
        """Weight all rows by a number."""
        return replace(self, triangle=self.triangle * factor)

    def residual_square(self, parameters: Parameters) -> float:
        """Give ||y - W parameters||^2."""
        rest = self.columns(TARGET)[:, 0] - self.columns(REGRESSOR) @ parameters
        return float(rest @ rest)

    @property
    def torque_square(self) -> float:
        """Give ||y||^2."""
        target = self.columns(TARGET)[:, 0]
        return float(target @ target)

    @property
    def _starts(self) -> dict[str, int]:
        """Give every group's first column."""
        widths = [width for _, width in self.groups]
        return {name: sum(widths[:index]) for index, (name, _) in enumerate(self.groups)}


def _triangle(rows: Rows) -> Rows:
    if len(rows) <= rows.shape[1]:
        return rows
    return np.asarray(np.linalg.qr(rows, mode="r"))
