"""Ask the rows that no fit has seen what they say of a member, and what would be to be expected of them.

Source: Stone, J. R. Stat. Soc. B 36(2), 1974, on judging by data that the choice has not seen.
"""

import numpy as np

from ..regression.prewhitening import white_left
from ..regression.rows import JointRows, extended
from .fitter import Bench
from .hypothesis import Hypothesis


def unseen_rise(bench: Bench, now: Hypothesis, trial: Hypothesis, index: int = -1) -> float:
    """Give the rise of twice the log-likelihood on held-out rows, at the larger hypothesis's noise.

    What was believed beforehand was not seen by either: by how much less the larger hypothesis departs
    from it counts like rows, in proportion to those that are held out.
    """
    share = unseen_share(bench, trial, index) if bench.belief else 0.0
    return _rise_at(bench, bench.unseen, now, trial, share)


def expected_unseen_rise(bench: Bench, now: Hypothesis, trial: Hypothesis, index: int) -> float:
    """Give what `unseen_rise` would be if a member did there what it does on the fitted rows."""
    return unseen_share(bench, trial, index) * _rise_at(bench, bench.base, now, trial, 1.0)


def unseen_share(bench: Bench, trial: Hypothesis, index: int = -1) -> float:
    """Give the square of a member's torque on held-out rows over that on the fitted ones."""
    columns = bench.columns(trial.members)[index]
    values = trial.fit.values[trial.columns_of(index % len(trial.members))]
    squares = []
    for part in (bench.unseen, bench.base):
        total = 0.0
        for joint, one in columns.items():
            torque = (one[part[joint].rows] @ values)[:, None]
            total += float(np.sum(trial.fit.joints[joint].noise.whitened(torque, part[joint].place) ** 2))
        squares.append(total)
    return squares[0] / max(squares[1], 1e-300)


def _rise_at(
    bench: Bench, joints: tuple[JointRows, ...], now: Hypothesis, trial: Hypothesis, believed: float
) -> float:
    rows = [extended(joints, bench.columns(one.members)) for one in (now, trial)]
    squares = np.zeros(2)
    for parts, joint in zip(zip(*rows, strict=True), trial.fit.joints, strict=True):
        left = [
            part.torque - part.columns @ one.fit.values for part, one in zip(parts, (now, trial), strict=True)
        ]
        squares += np.sum(white_left(parts[0], joint.noise, np.column_stack(left)) ** 2, axis=0)
    if bench.belief:
        squares += [believed * bench.belief.departure(one.fit.values) for one in (now, trial)]
    return float(squares[0] - squares[1])
