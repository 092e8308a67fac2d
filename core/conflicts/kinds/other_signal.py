"""Test whether what was logged as a joint's torque is another signal: its speed, a temperature, noise.

A channel that repeats a motion or another torque shows it by itself. Of any other that is no torque, nothing
can be predicted, neither by the model nor by forces that follow the positions.
"""

from collections.abc import Iterator
from typing import ClassVar

import numpy as np

from ...arrays import InstantSeries, JointSeries, SampleMask, Series, Vector
from ..conflict import Conflict, Hypothesis
from ..equations import Equations, Rows
from ..position_forces import beside_forces
from ..samples import Samples
from ..setup import Setup
from ..thresholds import DECISION, OTHER_SIGNAL
from ..trial import Trials

MAGNITUDE = "without a sign: it comes to zero and never passes it"


class OtherSignal(Conflict):
    """Leave out the torque of a joint."""

    name: ClassVar[str] = "other_signal"
    title: ClassVar[str] = "Another signal in a torque's place"

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Leave out each torque that follows neither the model's columns nor the positions."""
        present = trials.outcome(setup)
        failed = [] if present is None else np.flatnonzero(present.errors > DECISION.failed).tolist()
        fitted = trials.samples.moved(setup.assignment).usable[~trials.samples.judged].any(axis=0)
        asked = [joint for joint in _measured(setup, trials) if joint in failed and fitted[joint]]
        if not asked:
            return
        free = beside_forces(trials, setup).equations(setup)
        for joint in asked:
            if _predictable(free, joint, trials.samples.judged) < OTHER_SIGNAL.predictable:
                yield _left_out(setup, joint, "follows neither its motion nor its position")


def copied_signals(setup: Setup, trials: Trials) -> Iterator[tuple[Hypothesis, ...]]:
    """Leave out each torque that has no sign or repeats a motion; of two torques that are one, either."""
    samples = trials.samples.moved(setup.assignment)
    torque = setup.assignment.torque.of(samples.torque)
    measured = _measured(setup, trials)
    for joint in measured:
        is_magnitude = samples.unsigned[setup.assignment.torque.source[joint]]
        signal = MAGNITUDE if is_magnitude else _repeated(joint, torque[:, joint], samples)
        if signal:
            yield (_left_out(setup, joint, f"is {signal}", copied=True),)
            continue
        for other in measured:
            rows = samples.usable[:, joint] & samples.usable[:, other]
            if other > joint and _is_same(torque[:, other], torque[:, joint], rows):
                both = f"is that of joint {{}} as well: torques of joints {joint + 1} and {other + 1} are one"
                yield (
                    _left_out(setup, joint, both.format(other + 1), copied=True),
                    _left_out(setup, other, both.format(joint + 1), copied=True),
                )


def _measured(setup: Setup, trials: Trials) -> list[int]:
    """List the joints, from 0, that move and whose torque is used."""
    moves, factor = trials.moves(setup), setup.assignment.torque.factor
    return [joint for joint in range(setup.joints) if moves[joint] and factor[joint] != 0.0]


def _left_out(setup: Setup, joint: int, says: str, *, copied: bool = False) -> Hypothesis:
    named = f"the torque of joint {joint + 1}"
    return Hypothesis(
        OtherSignal.name,
        (joint + 1,),
        "torque",
        setup.with_torque(setup.assignment.torque.scaled(0.0, joint)),
        f"{named} {says}",
        f"map the column that is {named}, or leave it out by a scale of 0",
        expected=copied,
        is_shown=copied,
    )


def _repeated(joint: int, torque: Vector, samples: Samples) -> str:
    """Name the motion that a joint's torque repeats, its own first; nothing where it repeats none."""
    rows = samples.usable[:, joint]
    for name, series in (
        ("position", samples.position),
        ("velocity", samples.velocity),
        ("acceleration", samples.acceleration),
    ):
        follows = _follows(series, torque, rows)
        if follows.any():
            return f"the {name} of joint {(joint if follows[joint] else int(np.argmax(follows))) + 1}"
    return ""


def _follows(series: JointSeries, torque: Vector, rows: SampleMask) -> np.ndarray:
    """Mark the series that a torque is, but for an offset and a factor."""
    own, others = (_centred(each[rows]) for each in (torque[:, None], series))
    size, product = np.einsum("ij,ij->j", others, others), others.T @ own[:, 0]
    whole = float(own[:, 0] @ own[:, 0])
    return np.asarray(whole - product**2 / np.where(size > 0.0, size, np.inf) < OTHER_SIGNAL.copy**2 * whole)


def _is_same(first: Vector, second: Vector, rows: SampleMask) -> bool:
    own, other = (_centred(each[rows]) for each in (first, second))
    return bool((own - other) @ (own - other) < OTHER_SIGNAL.copy**2 * (own @ own))


def _centred(series: InstantSeries) -> InstantSeries:
    return np.asarray(series - series.mean(axis=0)) if len(series) else series


def _predictable(equations: Equations, joint: int, judged: SampleMask) -> float:
    """Give the share of a torque's variance that a free fit of its own rows predicts on others, below 1.

    The fit has slow functions of time as well: what warms, drifts or leans on an arm is no other signal.
    """
    (columns, torque), (others, measured) = (
        _own_rows(rows, equations, joint, mask)
        for rows, mask in ((equations.regressor.fitted, ~judged), (equations.regressor.judged, judged))
    )
    sizes = np.linalg.norm(columns, axis=1)
    used = sizes > 0.0
    scaled = columns[used] / sizes[used, None]
    products = scaled @ scaled.T + OTHER_SIGNAL.ridge * np.eye(len(scaled))
    free = np.linalg.solve(products, scaled @ torque)
    left = measured - (free / sizes[used]) @ others[used]
    varies = measured - torque.mean()
    return 1.0 - float(left @ left) / max(float(varies @ varies), np.finfo(float).tiny)


def _own_rows(rows: Rows, equations: Equations, joint: int, mask: SampleMask) -> tuple[Series, Vector]:
    """Give the columns of a joint's rows, half cosine waves over all samples among them, and the torque."""
    share = np.flatnonzero(mask)[rows.samples.usable[:, joint]] / len(mask)
    waves = np.cos(np.pi * np.outer(np.arange(1, OTHER_SIGNAL.waves + 1), share))
    return np.vstack([rows.columns[joint], waves]), rows.torque(equations.channels)[joint]
