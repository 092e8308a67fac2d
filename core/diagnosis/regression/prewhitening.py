"""Make one joint's rows white: columns and torque in units of a noise that remembers.

What a fit and a score are made of is the products of white columns, less what free columns span of them. Both
are kept, so that other columns beside the same ones cost what they are alone. Source: Aitken 1936.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array

from ...arrays import EquationRows, Indices, Matrix, SquareMatrix, Vector, Weights
from .ar_noise import ARNoise
from .nuisance import Nuisance, nuisance_of
from .rows import JointRows

ROUNDING = 1e-12
"""Share of a column's square below which what is left of it beside free columns is rounding."""


@dataclass(frozen=True, eq=False)
class Prewhitened:
    """Hold one joint's rows made white: columns and torque in units of the noise.

    Attributes
    ----------
    whitening
        What makes columns over the joint's rows white.
    acting
        Which columns are not all zero on the joint, in rising order: the others are left out below.
    columns, inside
        White columns, and what `free` ones span of them (see `Nuisance.inside`).
    gram
        Products of the columns with each other, less what free columns span.
    torque
        White torque, less what free columns span of it.
    """

    noise: ARNoise
    whitening: csr_array
    acting: Indices
    columns: EquationRows
    inside: EquationRows
    gram: SquareMatrix
    torque: Vector
    log_deviations: float
    free: Nuisance

    def of(self, some: slice) -> EquationRows:
        """Give those of some columns that are not all zero, white."""
        return self.columns[:, slice(*np.searchsorted(self.acting, (some.start, some.stop)))]

    def left(self, values: Weights) -> Vector:
        """Give what the columns leave of the torque, less what free columns span."""
        whole = (self.columns @ values[self.acting])[:, None]
        return np.asarray(self.torque - self.free.cleared(whole)[:, 0])

    def missed(self, rows: JointRows, values: Weights) -> Vector:
        """Give what the columns leave of the same rows, N m, what free ones take being judged when white."""
        left = rows.torque - rows.columns @ values
        return np.asarray(left - rows.free.columns @ self.free.coefficients(self.whitening @ left))

    def with_columns(self, kept: int, further: Matrix) -> "Prewhitened":
        """Keep the first columns and put others, not yet white, beside them."""
        own = int(np.searchsorted(self.acting, kept))
        before, inside_before = self.columns[:, :own], self.inside[:, :own]
        if not further.any():
            return replace(
                self,
                acting=self.acting[:own],
                columns=before,
                inside=inside_before,
                gram=self.gram[:own, :own],
            )
        new, white, inside = _white(self.whitening, self.free, further)
        gram = np.empty((own + len(new), own + len(new)))
        gram[:own, :own] = self.gram[:own, :own]
        gram[:own, own:] = before.T @ white - inside_before.T @ inside
        gram[own:, :own] = gram[:own, own:].T
        gram[own:, own:] = _gram(white, inside)
        return replace(
            self,
            acting=np.append(self.acting[:own], kept + new),
            columns=np.hstack([before, white]),
            inside=np.hstack([inside_before, inside]),
            gram=gram,
        )


def whitened(rows: JointRows, noise: ARNoise) -> Prewhitened:
    """Whiten one joint's rows."""
    whitening, free = _noise_of(rows, noise)
    acting, columns, inside = _white(whitening, free, rows.columns)
    torque = free.cleared((whitening @ rows.torque)[:, None])[:, 0]
    return Prewhitened(
        noise=noise,
        whitening=whitening,
        acting=acting,
        columns=columns,
        inside=inside,
        gram=_gram(columns, inside),
        torque=torque,
        log_deviations=noise.log_deviations(rows.place),
        free=free,
    )


def prewhitened_residual(rows: JointRows, noise: ARNoise, left: Matrix) -> EquationRows:
    """Whiten what some fits leave of one joint's rows, a column each, less what free columns span of it."""
    whitening, free = _noise_of(rows, noise)
    return free.cleared(whitening @ left)


def _noise_of(rows: JointRows, noise: ARNoise) -> tuple[csr_array, Nuisance]:
    """Give what makes a joint's rows white, and its free columns when white."""
    whitening = noise.whitening(rows.place)
    return whitening, nuisance_of(whitening @ rows.free.columns)


def _white(
    whitening: csr_array, free: Nuisance, columns: Matrix
) -> tuple[Indices, EquationRows, EquationRows]:
    """List the columns that act at all, and give them white, with what free ones span of them."""
    acting = np.flatnonzero(columns.any(axis=0))
    white = np.asarray(whitening @ columns[:, acting])
    return acting, white, free.inside(white)


def _gram(columns: EquationRows, inside: EquationRows) -> SquareMatrix:
    whole = columns.T @ columns
    return np.asarray(whole - inside.T @ inside + ROUNDING * np.diag(np.diag(whole)))
