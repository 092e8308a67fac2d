"""Prewhiten one joint's rows: columns and torque in units of the AR noise.

Fits and score tests are made of products of white columns, less their part in the nuisance span. Both are
kept, so that further columns cost what they are alone. Source: Aitken 1936.
"""

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import EquationRows, Indices, Matrix, SquareMatrix, Vector, Weights
from .ar_noise import ARNoise
from .nuisance import Nuisance, nuisance_of
from .rows import JointRows

ROUNDING = 1e-12
"""Share of a column's square below which what is left of it beside nuisance columns is rounding."""


@dataclass(frozen=True, eq=False)
class Prewhitened:
    """Hold one joint's prewhitened rows: columns and torque in units of the noise."""

    noise: ARNoise
    run_index: Indices
    """The model, and the index of each of the joint's rows within its run."""
    acting: Indices
    """Which columns are not all zero on the joint, in rising order: the others are left out below."""
    columns: EquationRows
    inside: EquationRows
    """White columns, and what the nuisance columns span of them (see `Nuisance.in_span`)."""
    gram: SquareMatrix
    """Products of the columns with each other, less what nuisance columns span."""
    torque: Vector
    """White torque, less what nuisance columns span of it."""
    log_deviations: float
    nuisance: Nuisance

    def white(self, columns: Matrix) -> EquationRows:
        """Prewhiten columns over the joint's rows."""
        return self.noise.whitened(columns, self.run_index)

    def of(self, some: slice) -> EquationRows:
        """Give those of some columns that are not all zero, white."""
        return self.columns[:, slice(*np.searchsorted(self.acting, (some.start, some.stop)))]

    def left(self, values: Weights) -> Vector:
        """Give what the columns leave of the torque, less what nuisance columns span."""
        whole = (self.columns @ values[self.acting])[:, None]
        return np.asarray(self.torque - self.nuisance.without_nuisance(whole)[:, 0])

    def residual(self, rows: JointRows, values: Weights) -> Vector:
        """Give what the columns leave of the same rows, N m, what free ones take being judged when white."""
        left = rows.left(values)
        free = self.nuisance.coefficients(self.white(left[:, None])[:, 0])
        return np.asarray(left - rows.nuisance.columns.combined(free[:, None])[:, 0])

    def with_columns(self, kept: int, rows: JointRows) -> "Prewhitened":
        """Keep the first columns and put those behind of the same rows, not yet white, beside them."""
        own, first = (int(np.searchsorted(acting, kept)) for acting in (self.acting, rows.acting))
        before, kept_inside = self.columns[:, :own], self.inside[:, :own]
        new = rows.acting[first:]
        if not len(new):
            return replace(
                self, acting=self.acting[:own], columns=before, inside=kept_inside, gram=self.gram[:own, :own]
            )
        white = self.white(rows.columns[:, first:])
        inside = self.nuisance.in_span(white)
        gram = np.empty((own + len(new), own + len(new)))
        gram[:own, :own] = self.gram[:own, :own]
        gram[:own, own:] = before.T @ white - kept_inside.T @ inside
        gram[own:, :own] = gram[:own, own:].T
        gram[own:, own:] = _gram(white, inside)
        return replace(
            self,
            acting=np.append(self.acting[:own], new),
            columns=np.hstack([before, white]),
            inside=np.hstack([kept_inside, inside]),
            gram=gram,
        )


def prewhiten(rows: JointRows, noise: ARNoise) -> Prewhitened:
    """Whiten one joint's rows."""
    nuisance = _white_nuisance(rows, noise)
    columns = noise.whitened(rows.columns, rows.run_index)
    inside = nuisance.in_span(columns)
    torque = nuisance.without_nuisance(noise.whitened(rows.torque[:, None], rows.run_index))[:, 0]
    return Prewhitened(
        noise=noise,
        run_index=rows.run_index,
        acting=rows.acting,
        columns=columns,
        inside=inside,
        gram=_gram(columns, inside),
        torque=torque,
        log_deviations=noise.log_deviations(rows.run_index),
        nuisance=nuisance,
    )


def prewhitened_residual(rows: JointRows, noise: ARNoise, left: Matrix) -> EquationRows:
    """Prewhiten residuals of one joint's rows, a column each, on the complement of the nuisance columns."""
    return _white_nuisance(rows, noise).without_nuisance(noise.whitened(left, rows.run_index))


def _white_nuisance(rows: JointRows, noise: ARNoise) -> Nuisance:
    return nuisance_of(rows.nuisance.columns.prewhitened(rows.run_index, noise.weights))


def _gram(columns: EquationRows, inside: EquationRows) -> SquareMatrix:
    whole = columns.T @ columns
    return np.asarray(whole - inside.T @ inside + ROUNDING * np.diag(np.diag(whole)))
