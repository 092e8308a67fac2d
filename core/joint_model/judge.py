"""Judge a fitted model: what is known of its quantities, its errors on held-out rows, and whether it is seen.

A spring is reported only where five tests agree that the log shows it. Each of them refuses with its numbers.
"""

from collections.abc import Iterable, Mapping
from typing import Final

import numpy as np

from ..arrays import Samples, Vector
from ..errors import ExcitationError
from ..validation.springs_seen import HIGHEST_SHARE, reasons_unseen, torque_share
from .orders import TIME_UNIT, Quantity, differences
from .record import JointRecord
from .refined_iv import Fitted, residual, torque_part
from .result import FoundModel, HeldOut, Known

CLEAR: Final = 3.0
"""Standard deviations by which held-out innovations have to fall, and below zero from which a friction or
damping is impossible."""
NEGLIGIBLE: Final = 1e-3
"""Share of the torque's RMS below which friction or damping of either sign is none."""
MANY_TURNS: Final = 10.0
"""Reversals per second from which short stands between them matter. A slide with 0.6 has the published
friction, a simulated joint with 2 its own; others with 95 have inertias 1 to 4 % off. Set by hand."""
BETWEEN_SAMPLES: Final = 0.5
"""Samples by which a torque may be late or early: one that is not held between samples is half of one."""
BLOCKS: Final = 20
"""Blocks of held-out rows."""


def known(fitted: Fitted, loads: tuple[Quantity, ...]) -> tuple[Known, Known]:
    """Give the quantities and the frequencies of a model with deviations, by the delta method."""
    model = fitted.model
    order, count = model.order, len(model.coefficients)
    quantities = order.physical(model.coefficients)
    slopes = differences(order.physical, model.coefficients)
    both = np.zeros((len(quantities) + len(loads), len(model.unknowns)))
    both[: len(quantities), :count] = slopes
    both[len(quantities) :, count:] = np.eye(len(loads))
    parameters = Known(
        (*order.quantities, *loads), np.concatenate([quantities, model.loads]), _deviations(both, fitted)
    )
    frequencies = tuple(Quantity(name, "f", "Hz") for name in order.frequencies)
    if not frequencies or min(quantities[:3]) <= 0.0:
        return parameters, Known((), np.zeros(0), np.zeros(0))
    along = differences(order.modes, quantities) @ both[: len(quantities)]
    return parameters, Known(frequencies, order.modes(quantities), _deviations(along, fitted))


def _deviations(slopes: np.ndarray, fitted: Fitted) -> Vector:
    variance = np.einsum("ij,jk,ik->i", slopes, fitted.covariance, slopes)
    return np.asarray(np.sqrt(np.maximum(variance, 0.0)))


def held_out(fitted: Fitted, simulated: Samples | None) -> HeldOut:
    """Give the errors on held-out rows.

    Parameters
    ----------
    simulated
        The position under the log's controller, where it is known, rad or m.
    """
    task = fitted.task
    left = residual(fitted.model, task)
    settled, rows, first = left.settled(task.fitted), slice(task.fitted, None), slice(0, task.fitted)
    blocks = np.array_split(settled[rows] / left.feedthrough, BLOCKS)
    torque = torque_part(fitted.model, task)
    errors = [100.0 * _rms(settled[part]) / _rms(torque[part]) for part in (rows, first)]
    squares = np.array([float(np.mean(block**2)) for block in blocks])
    if simulated is None:
        return HeldOut(errors[0], errors[1], squares)
    missed = simulated[rows] - task.origin - task.position[rows]
    motion = task.position[rows] - np.mean(task.position[rows])
    return HeldOut(errors[0], errors[1], squares, _rms(missed), 100.0 * _rms(missed) / _rms(motion))


def _rms(values: Samples) -> float:
    return float(np.sqrt(np.mean(values**2)))


def impossible(fitted: Fitted, parameters: Known) -> ExcitationError | None:
    """Say why no joint has a model: an inertia or the stiffness is not positive, or a friction negative."""
    least = {"coulomb": NEGLIGIBLE * _rms(fitted.task.signals.torque)}
    least["viscous"] = least["damping"] = least["coulomb"] / _speed(fitted)
    wrong = [
        quantity.name
        for quantity, value, deviation in zip(
            parameters.quantities, parameters.values, parameters.deviations, strict=True
        )
        if (quantity.positive and not value > 0.0)
        or value < -max(CLEAR * deviation, least.get(quantity.name, np.inf))
    ]
    if not wrong:
        return None
    return ExcitationError(
        f"the {fitted.model.order.name} model of the joint is not physically possible: {', '.join(wrong)}",
        evidence={
            quantity.name: [float(f"{value:.4g}"), float(f"{deviation:.2g}")]
            for quantity, value, deviation in zip(
                parameters.quantities, parameters.values, parameters.deviations, strict=True
            )
        },
        remedy="ask for the other order; let the joint move with frequencies up to its mode",
    )


def _speed(fitted: Fitted) -> float:
    """Give the RMS speed, rad/s or m/s."""
    return _rms(np.diff(fitted.task.position)) / (fitted.task.step * TIME_UNIT)


def unsettled(fitted: Fitted) -> ExcitationError | None:
    """Say that the steps of a fit did not converge."""
    if fitted.converged:
        return None
    return ExcitationError(
        f"the steps to the {fitted.model.order.name} model of the joint do not converge",
        evidence={"steps": len(fitted.steps), "last_change": float(f"{fitted.steps[-1].change:.3g}")},
        remedy="let the joint move with more frequencies, and longer; or ask for the other order",
    )


def turns_often(record: JointRecord, parameters: Known) -> bool:
    """Tell whether a joint with dry friction reverses so often that its short stands matter."""
    friction, deviation = parameters.at("coulomb")
    turns = np.count_nonzero(np.diff(record.direction[record.direction != 0.0]))
    often = turns > MANY_TURNS * len(record.position) * record.step
    return bool(often and friction > max(CLEAR * deviation, NEGLIGIBLE * _rms(record.torque)))


def is_late(record: JointRecord, late: tuple[float, float]) -> bool:
    """Tell whether the torque is clearly later or earlier than what holds between samples allows."""
    seconds, deviation = late
    return abs(seconds) > BETWEEN_SAMPLES * record.step + CLEAR * deviation


def not_seen(evidence: Mapping[str, float]) -> ExcitationError | None:
    """Say why the log does not show the spring of a flexible model.

    The mode is too fast, the torque carries too little around it, the stiffness is poorly known, or held-out
    rows are not predicted better than by the rigid model.
    """
    reasons = list(_reasons(evidence))
    if not reasons:
        return None
    return ExcitationError(
        f"the log does not show that the joint is flexible: {'; '.join(reasons)}",
        evidence=dict(evidence),
        remedy="use the rigid model, or let the joint move alone with frequencies up to the mode, sampled at"
        f" more than {1.0 / HIGHEST_SHARE:.2g} times the mode",
    )


def comparison(flexible: FoundModel, rigid: FoundModel, record: JointRecord) -> dict[str, float]:
    """Give the numbers that tell flexible and rigid apart."""
    stiffness, deviation = flexible.parameters.at("stiffness")
    natural, antiresonance = flexible.modes.values
    gained = rigid.held_out.innovations - flexible.held_out.innovations
    spread = float(np.std(gained, ddof=1) / np.sqrt(len(gained)))
    return {
        "natural_hz": float(natural),
        "antiresonance_hz": float(antiresonance),
        "rate_hz": 1.0 / record.step,
        "stiffness_deviation_percent": 100.0 * deviation / abs(stiffness),
        "torque_share_percent": 100.0
        * torque_share(record.torque, 1.0 / record.step, float(antiresonance), float(natural)),
        "innovation_ratio": float(
            np.sqrt(np.mean(flexible.held_out.innovations) / np.mean(rigid.held_out.innovations))
        ),
        "innovation_gain_deviations": float(np.mean(gained)) / spread if spread > 0.0 else 0.0,
    }


def _reasons(evidence: Mapping[str, float]) -> Iterable[str]:
    yield from reasons_unseen(evidence)
    gain = evidence["innovation_gain_deviations"]
    if not gain >= CLEAR:
        yield (
            f"it predicts held-out rows no better than the rigid model ({gain:.2g} deviations, not {CLEAR:g})"
        )


def crossover_hz(fitted: Fitted) -> float:
    """Give the frequency below which noise of the torque outweighs that of positions."""
    return fitted.task.crossover / (2.0 * np.pi * TIME_UNIT)
