"""Predict by how much noise of positions attenuates the inertias that least squares finds.

Least squares solves (S + C) chi = S chi_true, S being the products of the columns without noise and C those
of their noise. So it misses (S + C)^-1 C chi_true. Of that, the part in the joints' own inertias is told.
Source: Fuller, Measurement Error Models (1987), ch. 1 and 3.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import BaseParameters, JointVector
from ..estimate.system import joint_noise, solved_by, stacked
from ..regressor.column_noise import acceleration_columns, noise_products
from ..regressor.observe import Observation
from ..signals.condition import Motion
from ..signals.filtered_noise import acceleration_variance

_POSITIONS = 64
"""So many positions tell the mean inertias and the mean products of noise."""


@dataclass(frozen=True, eq=False)
class Attenuation:
    """Hold, per joint, what noise of positions makes of its inertia, the mean over its positions."""

    missed: JointVector
    """Share of the inertia that least squares misses; NaN where none is modelled, or the joint stands."""
    noise: JointVector
    """RMS noise of its positions, rad or m, the largest of all logs."""
    cutoff_hz: float
    """The widest band of the logs."""


def attenuation(
    observation: Observation, fitted: tuple[int, ...], motions: Sequence[Motion], base: BaseParameters
) -> Attenuation:
    """Predict what least squares on the measured columns misses.

    Parameters
    ----------
    observation, fitted
        The rows as they were measured, and which blocks of them are fitted.
    base
        The parameters that were found.
    """
    plan, factors = observation.plan, observation.joint_factors(fitted)
    noise = joint_noise(factors, plan.columns_of, base)
    positions = observation.positions[:: 1 + len(observation.positions) // _POSITIONS]
    columns = acceleration_columns(plan, positions)
    products = np.zeros((len(base), len(base)))
    added = noise_products(plan, columns, acceleration_variance(motions))
    for own, factor, place, sigma in zip(added, factors, plan.columns_of, noise, strict=True):
        products[np.ix_(place, place)] += own * factor.rows / sigma**2
    triangle = stacked(factors, plan.columns_of, len(base), noise).triangle
    missed = solved_by(triangle, solved_by(triangle.T, (products @ base)[:, None]))[:, 0]
    inertias, lost = np.array(
        [
            [columns[joint, rows].mean(axis=1) @ values[place] for values in (base, missed)]
            for joint, (rows, place) in enumerate(zip(plan.rows_of, plan.columns_of, strict=True))
        ]
    ).T
    known = [motion.recipe for motion in motions]
    moves = ~np.all([recipe.held for recipe in known], axis=0)
    shares = np.divide(lost, inertias, out=np.full(len(inertias), np.nan), where=moves & (inertias > 0.0))
    return Attenuation(
        shares,
        np.max([recipe.position_noise for recipe in known], axis=0),
        max(recipe.cutoff_hz for recipe in known),
    )
