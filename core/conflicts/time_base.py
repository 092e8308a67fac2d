"""Compare the stamps with a measured velocity: the one conflict that a log shows by itself.

Over a tenth of a second the integral of the velocity is the way that the positions cover, whatever the noise
of either. A factor that all moving joints share is the clock's. No fit can tell it: inertias absorb it.
"""

from itertools import pairwise

import numpy as np

from ..arrays import JointVector
from ..log.model import JointLog
from .thresholds import TIME_BASE


def stamp_factor(log: JointLog) -> float | None:
    """Give the factor by which all stamps' steps are too long; None where velocities do not show one.

    Factors that units explain better (degrees, revolutions, thousandths) are none of the clock's.
    """
    if "velocity" not in log.channels:
        return None
    sums = sum(_sums(log, start, stop) for start, stop in log.segments)
    ways, integrals, products = np.asarray(sums, dtype=float)
    moving = ways > TIME_BASE.moving * ways.max(initial=0.0)
    if not moving.any() or ways.max() == 0.0:
        return None
    together = products[moving] / np.sqrt(ways[moving] * integrals[moving])
    factors = products[moving] / ways[moving]
    shared = float(np.median(factors))
    agree = np.all(together > TIME_BASE.follows) and np.all(np.abs(factors / shared - 1.0) < TIME_BASE.alike)
    off = TIME_BASE.tolerance < abs(np.log(shared)) < TIME_BASE.furthest if shared > 0.0 else False
    return shared if agree and off else None


def _sums(log: JointLog, start: int, stop: int) -> np.ndarray:
    """Sum up, per joint, squared ways, squared integrals and their products."""
    block = max(round(TIME_BASE.seconds * log.rate_hz), 1)
    total = np.zeros((3, log.joints))
    for first, last in pairwise([*range(start, stop, 65536), stop]):
        rows = log.source.rows(first, last)
        if rows.velocity is None or len(rows.time) <= block:
            continue
        steps = np.diff(rows.time)[:, None]
        covered = np.cumsum(0.5 * (rows.velocity[1:] + rows.velocity[:-1]) * steps, axis=0)[::block]
        integrals, ways = np.diff(covered, axis=0), np.diff(rows.position[1::block], axis=0)
        total += np.array([_squares(ways, ways), _squares(integrals, integrals), _squares(ways, integrals)])
    return total


def _squares(first: np.ndarray, second: np.ndarray) -> JointVector:
    return np.asarray(np.sum(first * second, axis=0))
