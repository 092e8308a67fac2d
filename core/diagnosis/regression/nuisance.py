"""Project nuisance columns out of rows: columns with short support and arbitrary coefficients.

In the order of time such columns overlap with their neighbours only. Their Gram matrix is banded, and
factorising it costs as much as there are columns, not their cube. A second projection removes what rounding
leaves in the first, which grows with the square of their condition. Source: Bjorck, Numerical Methods for
Least Squares Problems (1996), ch. 6 (banded normal equations) and 2.4 (repeated orthogonalisation).
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg import cholesky_banded
from scipy.linalg.lapack import dpbtrs, dpstrf, dtbtrs
from scipy.sparse import csr_array

from ...arrays import EquationRows, Matrix, Vector, Weights
from ...numerics.short_columns import ShortColumns, short_columns

LEAST = 1e-4
"""A column smaller than this on the rows at hand acts elsewhere; so does one whose unit is all spanned but
this by the others. Far below it the Gram matrix, which squares it, would be rounding."""
EARLIER = 1e-9
"""By how much a column counts for more than the next: rounding must not choose between two that are alike."""
RIDGE = 1e-13
"""Share of a column's square, above rounding, that keeps the factor real; the second pass corrects it."""


@dataclass(frozen=True, eq=False)
class Nuisance:
    """Hold independent columns in the order of time, and the factor of their Gram matrix.

    The columns are scaled to unit size; `sizes` are those they had.
    """

    columns: ShortColumns
    factor: Matrix
    sizes: Vector

    @property
    def count(self) -> int:
        """Count the degrees of freedom that the columns take."""
        return self.columns.count

    def without_nuisance(self, rows: Matrix) -> Matrix:
        """Project columns over the same rows on the complement of the nuisance columns."""
        if not self.count:
            return rows
        for _ in range(2):
            along, _ = dpbtrs(self.factor, self.columns.products(rows), lower=1)
            rows = rows - self.columns.combined(along)
        return rows

    def coefficients(self, rows: Vector) -> Weights:
        """Give the least-squares coefficients of a column over the same rows, in the columns' own sizes."""
        along = np.zeros((self.count, 1))
        for _ in range(2 if self.count else 0):
            left = rows[:, None] - self.columns.combined(along)
            more, _ = dpbtrs(self.factor, self.columns.products(left), lower=1)
            along += more
        return np.asarray(along[:, 0] / self.sizes)

    def in_span(self, rows: Matrix) -> EquationRows:
        """Give the part of columns in the nuisance span along orthonormal axes.

        Where only products are needed this costs a quarter of the projection.
        """
        if not self.count or not rows.shape[1]:
            return np.zeros((self.count, rows.shape[1]))
        along, _ = dtbtrs(self.factor, self.columns.products(rows), uplo="L")
        return np.asarray(along)


def nuisance_of(columns: ShortColumns) -> Nuisance:
    """Factorise independent columns of any size.

    Parameters
    ----------
    columns
        In the order of time: what lies apart in the order must not overlap much.
    """
    sizes = columns.norms()
    scaled = columns.over(sizes)
    products = scaled.banded_gram()
    products[0] += RIDGE
    factor = cholesky_banded(products, lower=True) if products.size else products
    return Nuisance(scaled, factor, sizes)


def independent_nuisance(columns: csr_array) -> Nuisance:
    """Factorise those of some columns that are independent (see `independent_columns`)."""
    return nuisance_of(short_columns(independent_columns(columns)))


def independent_columns(columns: csr_array) -> csr_array:
    """Keep those columns that are neither nothing nor spanned by others, in the order they came in.

    Stretches of rest that touch share samples, and so do their polynomials, exactly.

    Examples
    --------
    >>> independent_columns(csr_array(np.array([[1.0, 2.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]]))).toarray().shape
    (2, 2)
    """
    acting = columns[:, _sizes(columns) > LEAST]
    scaled = _unit_columns(acting)
    gram = (scaled.T @ scaled).tocsr()
    products, kept = gram.toarray(), []
    for begin, end in _disjoint_groups(gram):
        first = 1.0 - EARLIER * np.arange(end - begin)
        group = products[begin:end, begin:end] * np.outer(first, first)
        _, order, rank, _ = dpstrf(group, tol=LEAST**2, lower=1)
        kept.append(begin + np.sort(order[:rank] - 1))
    return acting[:, np.concatenate(kept)] if kept else acting


def _disjoint_groups(gram: csr_array) -> list[tuple[int, int]]:
    """Cut columns, in the order of time, into groups that share no row with each other."""
    if not gram.nnz:
        return []
    furthest = np.maximum.accumulate(np.maximum.reduceat(gram.indices, gram.indptr[:-1]))
    ends = 1 + np.flatnonzero(furthest == np.arange(len(furthest)))
    return list(pairwise([0, *ends.tolist()]))


def _unit_columns(columns: csr_array) -> csr_array:
    """Give columns of unit size."""
    scaled = columns.data / _sizes(columns)[columns.indices]
    return csr_array((scaled, columns.indices, columns.indptr), columns.shape)


def _sizes(columns: csr_array) -> Vector:
    return np.sqrt(np.bincount(columns.indices, columns.data**2, minlength=columns.shape[1]))
