"""Prewhiten one joint's rows: columns and torque in units of the AR noise.

Fits and score tests are made of products of white columns, less their part in the nuisance span. Both are
kept, so that further columns cost what they are alone. Source: Aitken 1936.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array

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
    whitening: csr_array
    """What makes columns over the joint's rows white."""
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

    def of(self, some: slice) -> EquationRows:
        """Give those of some columns that are not all zero, white."""
        return self.columns[:, slice(*np.searchsorted(self.acting, (some.start, some.stop)))]

    def left(self, values: Weights) -> Vector:
        """Give what the columns leave of the torque, less what nuisance columns span."""
        whole = (self.columns @ values[self.acting])[:, None]
        return np.asarray(self.torque - self.nuisance.without_nuisance(whole)[:, 0])

    def residual(self, rows: JointRows, values: Weights) -> Vector:
        """Give what the columns leave of the same rows, N m, what free ones take being judged when white."""
        left = rows.torque - rows.columns @ values
        return np.asarray(left - rows.nuisance.columns @ self.nuisance.coefficients(self.whitening @ left))

    def with_columns(self, kept: int, further: Matrix) -> "Prewhitened":
        """Keep the first columns and put others, not yet white, beside them."""
        own = int(np.searchsorted(self.acting, kept))
        before, kept_inside = self.columns[:, :own], self.inside[:, :own]
        if not further.any():
            return replace(
                self, acting=self.acting[:own], columns=before, inside=kept_inside, gram=self.gram[:own, :own]
            )
        new, white, inside = _whiten(self.whitening, self.nuisance, further)
        gram = np.empty((own + len(new), own + len(new)))
        gram[:own, :own] = self.gram[:own, :own]
        gram[:own, own:] = before.T @ white - kept_inside.T @ inside
        gram[own:, :own] = gram[:own, own:].T
        gram[own:, own:] = _gram(white, inside)
        return replace(
            self,
            acting=np.append(self.acting[:own], kept + new),
            columns=np.hstack([before, white]),
            inside=np.hstack([kept_inside, inside]),
            gram=gram,
        )


def prewhiten(rows: JointRows, noise: ARNoise) -> Prewhitened:
    """Whiten one joint's rows."""
    whitening, nuisance = _noise_of(rows, noise)
    acting, columns, inside = _whiten(whitening, nuisance, rows.columns)
    torque = nuisance.without_nuisance((whitening @ rows.torque)[:, None])[:, 0]
    return Prewhitened(
        noise=noise,
        whitening=whitening,
        acting=acting,
        columns=columns,
        inside=inside,
        gram=_gram(columns, inside),
        torque=torque,
        log_deviations=noise.log_deviations(rows.run_index),
        nuisance=nuisance,
    )


def prewhitened_residual(rows: JointRows, noise: ARNoise, left: Matrix) -> EquationRows:
    """Prewhiten residuals of one joint's rows, a column each, on the complement of the nuisance columns."""
    whitening, nuisance = _noise_of(rows, noise)
    return nuisance.without_nuisance(whitening @ left)


def _noise_of(rows: JointRows, noise: ARNoise) -> tuple[csr_array, Nuisance]:
    """Give what makes a joint's rows white, and its nuisance columns when white."""
    whitening = noise.whitening(rows.run_index)
    return whitening, nuisance_of(whitening @ rows.nuisance.columns)


def _whiten(
    whitening: csr_array, nuisance: Nuisance, columns: Matrix
) -> tuple[Indices, EquationRows, EquationRows]:
    """List the columns that act at all, and give them white, with what free ones span of them."""
    acting = np.flatnonzero(columns.any(axis=0))
    white = np.asarray(whitening @ columns[:, acting])
    return acting, white, nuisance.in_span(white)


def _gram(columns: EquationRows, inside: EquationRows) -> SquareMatrix:
    whole = columns.T @ columns
    return np.asarray(whole - inside.T @ inside + ROUNDING * np.diag(np.diag(whole)))
