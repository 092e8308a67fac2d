"""Take the products of a regressor that is a sum of parts, each times a coordinate.

Such a sum is the regressor under any gravity, or with any length in one place of the table. The products are
quadratic in the coordinates, so that many set-ups are bounded at the cost of a few.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Indices, JointVector, Matrix, Series, Vector
from ..log.columns.assignment import Channels
from .reduced import RIDGE, Reduced, ridge


@dataclass(frozen=True, eq=False)
class MotionProducts:
    """Hold the products of one regressor, or of several along leading axes, with all measured torques."""

    products: np.ndarray
    """Joints x columns x columns."""
    moments: np.ndarray
    """Joints x torques x columns."""
    squares: Matrix
    """Joints x torques: what own columns leave of a torque over a joint's rows."""
    torques: Matrix
    """The same of the whole torques."""
    rows: JointVector

    def read(self, torque: Channels) -> Reduced:
        """Take the joints' torques as they are assigned."""
        joints, source, factor = np.arange(len(self.rows)), list(torque.source), np.array(torque.factor)
        moments = factor[:, None] * self.moments[..., joints, source, :]
        leading = moments.shape[:-1]
        squares, torques = (
            np.broadcast_to(factor**2 * own[joints, source], leading) for own in (self.squares, self.torques)
        )
        return Reduced(self.products, moments, squares, torques, self.rows)


@dataclass(frozen=True, eq=False)
class RegressorFamily:
    """Hold the products of parts with each other: parts x parts x joints x columns x columns."""

    products: np.ndarray
    moments: np.ndarray
    """Parts x joints x torques x columns."""
    squares: Matrix
    torques: Matrix
    rows: JointVector

    def at(self, coordinates: np.ndarray) -> MotionProducts:
        """Add up the parts, with coordinates along the last axis."""
        parts, _, *shape = self.products.shape
        *leading, _ = coordinates.shape
        pairs = (coordinates[..., :, None] * coordinates[..., None, :]).reshape(*leading, parts * parts)
        products = (pairs @ self.products.reshape(parts * parts, -1)).reshape(*leading, *shape)
        moments = np.tensordot(coordinates, self.moments, axes=1)
        return MotionProducts(products, moments, self.squares, self.torques, self.rows)


def family(
    parts: Sequence[Sequence[Series]], columns_of: Sequence[Indices], torque: Sequence[Series]
) -> RegressorFamily:
    """Take the products of the parts' rows (per joint, columns x instants) with each other and the torques.

    Columns of one joint alone that no coordinate changes are projected out.
    """
    whole = [np.stack(rows) for rows in zip(*parts, strict=True)]
    changed = [_significant(rows) for rows in whole]
    own = _own_columns(changed, columns_of)
    place, size = np.cumsum(~own) - 1, np.count_nonzero(~own)
    joints, channels, every = len(columns_of), len(torque[0]), len(parts) * size
    products, moments = np.zeros((joints, every, every)), np.zeros((joints, every, channels))
    squares, torques = np.zeros((2, joints, channels))
    joined = zip(whole, changed, columns_of, torque, strict=True)
    for joint, (rows, significant, columns, measured) in enumerate(joined):
        mine = own[columns]
        part, row = np.nonzero(significant[:, ~mine])
        at = part * size + place[columns[~mine][row]]
        torques[joint] = np.einsum("ij,ij->i", measured, measured)
        left = _without_own(rows[0, mine], rows[:, ~mine][part, row], measured, torques[joint])
        products[joint][np.ix_(at, at)], moments[joint, at], squares[joint] = left
    count = np.array([float(max(measured.shape[1], 1)) for measured in torque])
    shape = joints, len(parts), size
    return RegressorFamily(
        np.einsum("jpcqd->pqjcd", products.reshape(*shape, *shape[1:])),
        np.einsum("jpct->pjtc", moments.reshape(*shape, channels)),
        squares,
        torques,
        count,
    )


def _significant(rows: np.ndarray) -> np.ndarray:
    """Tell which columns of which parts are not zero: parts x columns.

    What differences of parts leave by rounding of a column that no coordinate changes is made zero.
    """
    sizes = np.einsum("ijk,ijk->ij", rows, rows)
    nothing = sizes <= RIDGE * sizes.max(axis=0)
    rows[nothing] = 0.0
    return np.asarray(~nothing)


def _own_columns(significant: Sequence[np.ndarray], columns_of: Sequence[Indices]) -> np.ndarray:
    """Tell which columns are of one joint alone, and the same whatever the coordinates."""
    users = np.zeros(1 + max(int(columns.max(initial=-1)) for columns in columns_of))
    for parts, columns in zip(significant, columns_of, strict=True):
        users[columns] += 1.0
        users[columns[parts[1:].any(axis=0)]] = np.inf
    return np.asarray(users == 1.0)


def _without_own(own: Series, shared: Series, torque: Series, whole: Vector) -> tuple[Matrix, Matrix, Vector]:
    """Give the products of shared columns with each other and with torques, and the torques' squares.

    Own columns are projected out of all of them, also out of the squares of the `whole` torques. The torques
    may be many: they have no products.
    """
    norms = np.sqrt(np.add.reduce(own * own, axis=1))
    scaled = own / np.where(norms > 0.0, norms, 1.0)[:, None]
    alone = scaled @ scaled.T + ridge(len(own))
    beside, along = scaled @ shared.T, scaled @ torque.T
    across, taken = np.linalg.solve(alone, beside), np.linalg.solve(alone, along)
    products, moments = shared @ shared.T - beside.T @ across, shared @ torque.T - beside.T @ taken
    squares = np.maximum(whole - np.einsum("ij,ij->j", along, taken), 0.0)
    # Nothing is left of a column that is but for rounding in the span of the own ones.
    spanned = np.diag(products) <= RIDGE * np.einsum("ij,ij->i", shared, shared)
    products[spanned], products[:, spanned], moments[spanned] = 0.0, 0.0, 0.0
    return products, moments, squares
