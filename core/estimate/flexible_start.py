"""Find where an arm with flexible joints begins: without a simulation, from far off.

First each spring alone, to first order in its compliance; then all of them, with the links where the torques
say they are, by Gauss-Newton steps. Source: De Luca & Book, Springer Handbook of Robotics (2016), ch. 11.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from ..arrays import BaseParameters, JointSeries, Parameters, Vector
from ..dynamics.terms.flexible_joints import DAMPING, STIFFNESS
from ..errors import ExcitationError
from ..reduction.base import flexible_joints
from ..regressor.eliminated import ROTOR, EliminatedRows, SpringRows, Transmission, column_of
from ..regressor.observe import Observation
from ..simulation.closed_loop.springs import links_of
from ..simulation.mechanism import mechanism_of
from .problem import Problem
from .system import weighted

STEPS: Final = 9
"""Gauss-Newton steps: from half the stiffness, six leave less than the noise does."""
UNDAMPED: Final = 3
"""The first of them take the damping as zero: from far off it is of any sign."""
MOST_CHANGE: Final = 3.0
"""Factor by which one step changes a stiffness at most."""
HIGHEST_OVER_BAND: Final = 3.0
"""Largest mode to begin with, as a multiple of what the filter passes."""
ROWS_PER_UNKNOWN: Final = 3
"""Rows of a joint away from its reversals per unknown, from which on the others are left out."""
ROTOR_SHARES: Final = (0.02, 0.98)
"""Least and largest share of a rotor in its joint's whole inertia to begin with."""


@dataclass(frozen=True, eq=False)
class FlexibleStart:
    """Hold a problem with flexible joints, and where it begins."""

    problem: Problem
    base: BaseParameters

    @property
    def transmission(self) -> Transmission:
        """Give what stands between torques and links."""
        return _transmission(self.problem, self.base)

    @property
    def differentiated(self) -> Observation:
        """Give the equations of a Gauss-Newton step from there."""
        return self.problem.observed(rows=_differentiated(self.problem, self.base, damped=True))

    def observed(self, base: BaseParameters) -> Observation:
        """Give the equations of motors and links, by which a robot of these base parameters is judged."""
        return self.problem.observed(rows=_rows(self.problem, base))


def _transmission(problem: Problem, base: BaseParameters) -> Transmission:
    """Give what stands between torques and links."""
    joints = np.array(flexible_joints(problem.base.model))
    names = [problem.base.model.parameters[column].name for column in problem.plan.columns]
    values = dict(zip(names, base, strict=True))

    def of(symbol: str) -> Vector:
        return np.array([values.get(f"{symbol}{joint + 1}", 0.0) for joint in joints])

    return Transmission(joints, of(STIFFNESS), of(DAMPING), of(ROTOR), of("FV"), of("FC"), of("OFF"))


def begin(problem: Problem) -> FlexibleStart:
    """Find stiffnesses, dampings and rotors to begin with.

    Raises
    ------
    ExcitationError
        If a spring's compliance is not positive: the log does not show that the joint is flexible.
    """
    base = _first(problem)
    unmoved = problem.observed(rows=_rows(problem, base))
    solved = _solved(problem, unmoved, len(base))
    base = _with_springs(problem, solved, base, 0)
    for number in range(STEPS):
        rows = _differentiated(problem, base, damped=number >= UNDAMPED)
        seen = problem.observed(rows=rows)
        found = _solved(problem, seen, len(base))
        base = _with_springs(problem, found, base, number)
    return FlexibleStart(problem, base)


def _solved(problem: Problem, seen: Observation, size: int) -> BaseParameters:
    """Solve by the rows away from reversals, unless they are too few."""
    fitted = seen.parts(problem.held_out)[0]
    moving, every = seen.moving_factors(fitted), seen.joint_factors(fitted)
    enough = all(factor.rows > ROWS_PER_UNKNOWN * size for factor in moving)
    return weighted(moving if enough else every, seen.columns_of, size).solved()


def _rows(problem: Problem, base: BaseParameters) -> EliminatedRows:
    recipes = [motion.recipe for motion in problem.motions]
    return EliminatedRows(problem.plan, _transmission(problem, base), recipes, base)


def _differentiated(problem: Problem, base: BaseParameters, *, damped: bool) -> EliminatedRows:
    mechanism = links_of(mechanism_of(problem.base.model, standard_of(problem, base)))

    def masses(positions: JointSeries) -> np.ndarray:
        return mechanism.mass_matrices(positions)

    return replace(_rows(problem, base), masses=masses, damped=damped)


def standard_of(problem: Problem, base: BaseParameters) -> Parameters:
    """Give standard parameters of these base ones, the others zero; friction at least zero."""
    model = problem.base.model
    standard = np.zeros(len(model.parameters))
    standard[list(problem.base.kept)] = base
    friction = [parameter.symbol.startswith("FC") for parameter in model.parameters]
    return np.where(friction, np.maximum(standard, 0.0), standard)


def _first(problem: Problem) -> BaseParameters:
    """Fit every spring alone: rigid columns, with the first order of the compliance beside them."""
    joints, size = np.array(flexible_joints(problem.base.model)), len(problem.plan.columns)
    rows = SpringRows(problem.plan, joints, [motion.recipe for motion in problem.motions])
    seen = problem.observed(rows=rows)
    found = _solved(problem, seen, size + 3 * len(joints))
    base, ratios = found[:size].copy(), found[size:].reshape(-1, 3)
    mechanism = mechanism_of(problem.base.model, standard_of(problem, base))
    inertia = np.diagonal(mechanism.mass_matrices(seen.positions), axis1=1, axis2=2).mean(axis=0)[joints]
    negative = [int(joint) + 1 for joint, own in zip(joints, inertia, strict=True) if own <= 0.0]
    if negative:
        raise ExcitationError(
            "torque and motion do not belong to masses with springs: the inertia of joint"
            f"{'s' * (len(negative) > 1)} {', '.join(map(str, negative))} would be negative",
            evidence={"joints": [int(joint) + 1 for joint in joints], "inertia": inertia.tolist()},
            remedy="check the sign of the torque and the units; let all joints speed up and slow down more",
        )
    band = max(motion.recipe.cutoff_hz for motion in problem.motions)
    least = (2.0 * np.pi * HIGHEST_OVER_BAND * band) ** -2
    known = ratios[:, 0] > least
    shares = np.divide(ratios[:, 1], ratios[:, 0] * inertia, out=np.full(len(joints), 0.5), where=known)
    rotors = np.clip(shares, *ROTOR_SHARES) * inertia
    stiffness = (inertia - rotors) / np.maximum(ratios[:, 0], least)
    for joint, rotor, spring in zip(joints, rotors, stiffness, strict=True):
        base[column_of(problem.plan, ROTOR, joint)] = rotor
        base[column_of(problem.plan, STIFFNESS, joint)] = spring
    return base


def _with_springs(
    problem: Problem, found: BaseParameters, before: BaseParameters, number: int
) -> BaseParameters:
    """Give what was found, with springs not too far from those before, and no negative damping."""
    base = found.copy()
    for joint in np.array(flexible_joints(problem.base.model)):
        stiff, damp, rotor = (
            column_of(problem.plan, symbol, joint) for symbol in (STIFFNESS, DAMPING, ROTOR)
        )
        base[stiff] = before[stiff] * _factor(found[stiff] / before[stiff])
        base[damp] = max(found[damp], 0.0) if number >= UNDAMPED else 0.0
        base[rotor] = max(found[rotor], ROTOR_SHARES[0] * before[rotor])
    return base


def _factor(ratio: float) -> float:
    """Give the factor on a stiffness whose first-order step leads to such a ratio: the compliance is stepped.

    Examples
    --------
    >>> _factor(0.75), _factor(0.0), _factor(5.0)
    (0.8, 1.0, 3.0)
    """
    if ratio == 0.0:
        return 1.0  # without derivatives nothing was fitted
    compliance = max(2.0 - ratio, 1.0 / MOST_CHANGE)
    return min(max(1.0 / compliance, 1.0 / MOST_CHANGE), MOST_CHANGE)
