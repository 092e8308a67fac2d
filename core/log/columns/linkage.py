"""Add positions that were read to others: a controller may count a link's angle from the horizontal.

Angles about parallel axes add up to a link's angle from the horizontal. Some controllers show this angle in
the place of the joint's own (the interaction of axes 2 and 3). Per joint, pairs say which other joint's
position (from 0) is added, how many times. What is added are the positions as they were read, so that the
order of the joints does not matter.
"""

from collections.abc import Sequence

import numpy as np

from ...arrays import JointSeries, SquareMatrix, Vector

Added = tuple[tuple[int, float], ...]
"""What is added to one joint's position: other joints, from 0, and factors."""
LINKED = ("position", "velocity", "position_ref", "velocity_ref")
"""The channels that may be linked."""
LARGEST_FACTOR = 1000.0
"""Of what is added: the angles of two links are of one size."""
_NOTHING = 1e-12
"""Factor below which it is what rounding leaves of none."""


def linked(read: JointSeries, added: Sequence[Added]) -> JointSeries:
    """Add positions, or velocities, that were read to others.

    Examples
    --------
    >>> linked(np.array([[1.0, 2.0]]), [(), ((0, -1.0),)])
    array([[1., 1.]])
    """
    return np.asarray(read @ _matrix(added).T) if any(added) else read


def one_after_another(
    first: Sequence[Added], source: Sequence[int], factor: Sequence[float], second: Sequence[Added]
) -> tuple[Added, ...]:
    """Give what is added where linked positions take other places, are multiplied, and are linked again."""
    if not any(first):
        return tuple(second)
    placed = _matrix(first)[np.ix_(source, source)] * np.outer(factor, 1.0 / np.array(factor))
    return _added(_matrix(second) @ placed)


def offset_before(offset: Sequence[float], whole: Sequence[Added], last: Sequence[Added]) -> Vector:
    """Give the offsets before the whole linkage that stand for those before its last one."""
    return np.asarray(np.linalg.solve(_matrix(whole), _matrix(last) @ np.array(offset)))


def are_told_apart(added: Sequence[Added]) -> bool:
    """Tell whether the positions that were read follow from the linked ones."""
    return int(np.linalg.matrix_rank(_matrix(added))) == len(added)


def as_linkage(added: Sequence[Added]) -> list[dict[str, float]]:
    """Write what is added as a mapping says it, with joints from 1.

    Examples
    --------
    >>> as_linkage([(), ((0, -1.0),)])
    [{'joint': 2, 'adds': 1, 'factor': -1.0}]
    """
    return [
        {"joint": joint, "adds": other + 1, "factor": factor}
        for joint, pairs in enumerate(added, 1)
        for other, factor in pairs
    ]


def _matrix(added: Sequence[Added]) -> SquareMatrix:
    matrix = np.eye(len(added))
    for joint, pairs in enumerate(added):
        for other, factor in pairs:
            matrix[joint, other] += factor
    return matrix


def _added(matrix: SquareMatrix) -> tuple[Added, ...]:
    beside = matrix - np.eye(len(matrix))
    beside[np.abs(beside) < _NOTHING] = 0.0
    return tuple(tuple((int(other), float(row[other])) for other in np.flatnonzero(row)) for row in beside)
