"""Score a prediction joint by joint, with the denominator of every relative error in its name.

An error of a tenth of the torque's range and one of a tenth of its RMS differ by a factor of three to six;
papers mix them. Rows beside a reversal are judged apart: there a sign of velocity does not tell friction.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import BaseParameters, Indices
from ..regressor.block import Block
from ..regressor.factor import Factor
from ..regressor.observe import Observation
from ..robot.joint_units import prismatic_joints


@dataclass(frozen=True)
class JointScore:
    """Score one joint over some blocks; torques in N m (N), relative errors in percent."""

    joint: int
    samples: int
    rms_torque: float
    rms_residual: float
    nrmse_of_range_percent: float
    nrmse_of_rms_percent: float


def scores(observation: Observation, chosen: tuple[int, ...], base: BaseParameters) -> tuple[JointScore, ...]:
    """Score every joint over the chosen blocks."""
    blocks = [observation.blocks[index] for index in chosen]
    factors = observation.scored_factors(chosen)
    return tuple(
        _score(joint, blocks, (factor.residual_square(base[columns]), factor.torque_square, factor.rows))
        for joint, (factor, columns) in enumerate(zip(factors, observation.columns_of, strict=True))
    )


def total_percent(observation: Observation, chosen: tuple[int, ...], base: BaseParameters) -> float:
    """Give 100 times the norm of the residual over the norm of the torque, all joints together.

    Notes
    -----
    Newtons are not added to newton metres: where joints turn and slide, the squared shares of both kinds are
    averaged.
    """
    return _total(observation, observation.scored_factors(chosen), base)


def reversals_percent(
    observation: Observation, chosen: tuple[int, ...], base: BaseParameters
) -> float | None:
    """Give the same of the rows beside reversals; None where there are none."""
    factors = observation.turning_factors(chosen)
    return _total(observation, factors, base) if any(factor.rows for factor in factors) else None


def _total(observation: Observation, factors: tuple[Factor, ...], base: BaseParameters) -> float:
    columns_of: tuple[Indices, ...] = observation.columns_of
    left = np.array(
        [factor.residual_square(base[columns]) for factor, columns in zip(factors, columns_of, strict=True)]
    )
    torque = np.array([factor.torque_square for factor in factors])
    prismatic = prismatic_joints(observation.plan.model.robot)
    kinds = [kind for kind in (prismatic, ~prismatic) if torque[kind].sum() > 0.0]
    if not kinds:
        return _percent(np.sqrt(left.sum()), 0.0)
    return _percent(np.sqrt(np.mean([left[kind].sum() / torque[kind].sum() for kind in kinds])), 1.0)


def _score(joint: int, blocks: list[Block], sums: tuple[float, float, int]) -> JointScore:
    left, torque, rows = sums
    residual, level = (float(np.sqrt(square / max(rows, 1))) for square in (left, torque))
    ranges = np.array([block.torque_range[joint] for block in blocks]).reshape(-1, 2)
    span = float(ranges[:, 1].max() - ranges[:, 0].min()) if rows else 0.0
    return JointScore(joint + 1, rows, level, residual, _percent(residual, span), _percent(residual, level))


def _percent(part: float, whole: float) -> float:
    return float(100.0 * part / whole) if whole > 0.0 else 0.0
