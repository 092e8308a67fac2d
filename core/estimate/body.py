"""Find the body nearest to ten parameters that belong to none, in units of how well they are known.

Noise moves the parameters of a small body to where no body can be. The nearest consistent one is reported,
and its distance says whether a body is a tenable explanation at all. Source: Wensing, Kim & Slotine,
IEEE RA-L 3(1), 2018.
"""

import clarabel
import numpy as np
from scipy import sparse

from ..arrays import LinkParameters, SquareMatrix
from .cones import svec_rows

LARGEST_DEVIATION = 100.0
"""In SI units: what is known worse is not known."""
LEFT_OUT = 1e-13
"""Share of the largest variance, below what any fit can tell from none."""


def nearest_body(
    values: LinkParameters, covariance: SquareMatrix, *, removed: bool = False
) -> tuple[LinkParameters, float]:
    """Give the nearest body and its squared distance in standard deviations.

    The distance is infinite where no body is near enough to be found.

    Parameters
    ----------
    values, covariance
        Ten parameters and how well they are known together.
    removed
        Whether a body was taken away: then it is minus the parameters that belong to one.

    Examples
    --------
    A kilogram at x = 0.1 m that weighs less about z than about y is a body already:

    >>> bar = np.array([0, 0, 0, 0.01, 0, 0.01, 0.1, 0, 0, 1.0])
    >>> bool(nearest_body(bar, 1e-6 * np.eye(10))[1] < 1e-6)
    True
    """
    root = _root(covariance)
    sign = -1.0 if removed else 1.0
    size = np.abs(values) + np.linalg.norm(root, axis=1)
    inertia, mass = max(float(size[[0, 3, 5]].max()), 1e-12), max(float(size[9]), 1e-12)
    cone = sign * svec_rows(np.array([inertia**-0.5] * 3 + [mass**-0.5]))
    answer = clarabel.DefaultSolver(
        sparse.eye(root.shape[1], format="csc"),
        np.zeros(root.shape[1]),
        sparse.csc_matrix(-cone @ root),
        cone @ values,
        [clarabel.PSDTriangleConeT(4)],
        _settings(),
    ).solve()
    if str(answer.status) not in ("Solved", "AlmostSolved"):
        return values, float("inf")
    step = np.array(answer.x)
    return np.asarray(values + root @ step), float(step @ step)


def _root(covariance: SquareMatrix) -> np.ndarray:
    """Give L with L L' the covariance, deviations cut off where nothing is known.

    Directions without any spread were left out of the fit: nothing is known of them either.
    """
    deviation = np.sqrt(np.diag(covariance))
    known = np.where(deviation > 0.0, np.minimum(deviation, LARGEST_DEVIATION), LARGEST_DEVIATION)
    scale = np.where(deviation > 0.0, deviation, 1.0)
    values, vectors = np.linalg.eigh(covariance / np.outer(scale, scale))
    spread = np.where(values > LEFT_OUT * max(float(values[-1]), 1e-300), np.maximum(values, 0.0), 1.0)
    return np.asarray(known[:, None] * vectors * np.sqrt(spread))


def _settings() -> object:
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    return settings
