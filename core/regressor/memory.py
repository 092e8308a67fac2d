"""Accumulate lagged products of rows: the autocovariance of a residual without storing W.

For filtered samples the residuals are not independent, and the textbook variance is wrong. The variance of a
least-squares estimate needs W'V W with V the residual's covariance; with V Toeplitz over a few lags that is a
sum of lagged products G_l = sum_t w(t) w(t + l)', which accumulate like any other statistic. With the torque
as last column of w the same products give the residual's autocovariance for any parameters. Where instruments
z stand before w, it is Z'V Z that is wanted. Source: Newey & West 1987, in its homoskedastic form.
"""

from dataclasses import dataclass, replace
from typing import ClassVar, Protocol, runtime_checkable

import numpy as np

from ..arrays import Indices, Matrix, Parameters, Rows, SampleMask, Vector


@runtime_checkable
class Memory(Protocol):
    """Tell how the rows of equations scatter, which need not be independent."""

    @property
    def rows(self) -> int:
        """Count the rows."""

    @property
    def instruments(self) -> int:
        """Count the columns of instruments."""

    @property
    def of_regressor(self) -> np.ndarray:
        """Give, per lag, what a fit takes of the residual for parameters of unit covariance."""

    def autocovariance(self, parameters: Parameters) -> Vector:
        """Sum the residual's products per lag, for these parameters."""

    def spread(self, autocovariance: Vector) -> Matrix:
        """Give the covariance of the columns' products with the noise, for this autocovariance of it."""


@dataclass(frozen=True, eq=False)
class LaggedProducts:
    """Hold G_0 .. G_LAGS of one joint's rows [w y], or [z w y], and their number.

    Rows that are not used must come in as zeros.
    """

    LAGS: ClassVar[int] = 12
    products: np.ndarray
    rows: int
    instruments: int = 0
    """Number of columns of z."""

    @classmethod
    def empty(cls, columns: int, instruments: int = 0) -> "LaggedProducts":
        """Start with no rows."""
        return cls(np.zeros((cls.LAGS + 1, columns, columns)), 0, instruments)

    def extended(self, rows: Rows, first: int, used: int) -> "LaggedProducts":
        """Take in the rows from the `first` on, of which `used` are not zero; those before it are taken."""
        products = self.products.copy()
        for lag in range(self.LAGS + 1):
            begin = max(first, lag)
            if begin < len(rows):
                products[lag] += rows[begin - lag : len(rows) - lag].T @ rows[begin:]
        return replace(self, products=products, rows=self.rows + used)

    def merged(self, other: "LaggedProducts") -> "LaggedProducts":
        """Join the products of two stretches."""
        return replace(self, products=self.products + other.products, rows=self.rows + other.rows)

    def over(self, columns: Indices) -> "LaggedProducts":
        """Keep the products of some of the columns; the last of those given is the torque's."""
        return LaggedProducts(self.products[:, columns[:, None], columns], self.rows)

    @property
    def of_regressor(self) -> np.ndarray:
        """Give the products of w with itself at lags 0..LAGS."""
        return self.products[:, self.instruments : -1, self.instruments : -1]

    def autocovariance(self, parameters: Parameters) -> Vector:
        """Sum the residual's products at lags 0..LAGS, for these parameters over the columns of w."""
        weights = np.concatenate([np.zeros(self.instruments), -parameters, [1.0]])
        return np.array([weights @ product @ weights for product in self.products])

    def spread(self, autocovariance: Vector) -> Matrix:
        """Give [Z W]'V [Z W] for this autocovariance, tapered after Bartlett so that V is positive."""
        width = len(autocovariance)
        total = autocovariance[0] * self.products[0][:-1, :-1]
        for lag in range(1, min(width, self.LAGS + 1)):
            weight = (1.0 - lag / width) * autocovariance[lag]
            product = self.products[lag][:-1, :-1]
            total += weight * (product + product.T)
        return np.asarray(total)


@dataclass(frozen=True, eq=False)
class TurningProducts:
    """Hold the part of a joint's lagged products that rows beside a reversal have in them.

    So that these rows can be weighted when their noise is known, without another pass over the log.
    """

    one: np.ndarray
    both: np.ndarray
    """Products of pairs of which one row, or both, lie beside a reversal. Only symmetric parts count."""

    @classmethod
    def empty(cls, columns: int) -> "TurningProducts":
        """Start with no rows."""
        none = np.zeros((LaggedProducts.LAGS + 1, columns, columns))
        return cls(none, none)

    def extended(self, rows: Rows, turning: SampleMask, first: int) -> "TurningProducts":
        """Take in the rows from the `first` on; those before it are already taken."""
        place, lags = np.flatnonzero(turning), np.arange(LaggedProducts.LAGS + 1)
        if not len(place):
            return self
        beyond = np.zeros((LaggedProducts.LAGS, rows.shape[1]))
        padded, marked = np.vstack([beyond, rows, beyond]), np.pad(turning, LaggedProducts.LAGS)
        at, known = place + LaggedProducts.LAGS, int(np.searchsorted(place, first))
        later = padded[at[:, None] + lags]  # a pair counts by its later row
        later[:known][(at[:known, None] + lags) < first + LaggedProducts.LAGS] = 0.0
        both = _products(rows[place], later * marked[at[:, None] + lags][:, :, None])
        later[known:] += padded[at[known:, None] - lags]
        # That counts pairs of which both rows are marked from either side.
        return TurningProducts(self.one + _products(rows[place], later) - 2.0 * both, self.both + both)

    def merged(self, other: "TurningProducts") -> "TurningProducts":
        """Join the products of two stretches."""
        return TurningProducts(self.one + other.one, self.both + other.both)

    def over(self, columns: Indices) -> "TurningProducts":
        """Keep the products of some of the columns; the last of those given is the torque's."""
        square = (slice(None), columns[:, None], columns)
        return TurningProducts(self.one[square], self.both[square])

    def discounted(self, whole: LaggedProducts, weight: float) -> LaggedProducts:
        """Give the lagged products of all rows, those beside a reversal times a weight."""
        less = (1.0 - weight) * self.one + (1.0 - weight**2) * self.both
        return replace(whole, products=whole.products - less)


def _products(rows: Rows, partners: np.ndarray) -> np.ndarray:
    """Multiply rows with those that are so many lags away: rows x lags x columns."""
    count, lags, columns = partners.shape
    products = rows.T @ partners.reshape(count, lags * columns)
    return np.moveaxis(products.reshape(-1, lags, columns), 1, 0)
