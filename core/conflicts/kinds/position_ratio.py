"""Test whether positions are those of motors: each joint's motion times the ratio of its gear.

The inertias of a joint alone absorb any factor on its position. Gravity, which is periodic in the angles, and
what a joint's speed does to other joints do not. So least squares has a minimum at the true factors, which is
found one joint after the other.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import fmin_powell, minimize_scalar

from ...arrays import JointVector, Vector
from ...log.channels import POSITIONS
from ..conflict import Hypothesis
from ..setup import Setup
from ..thresholds import RATIO, UNIT
from ..trial import Trials


def position_hypotheses(conflict: str, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
    """Give the likeliest factor of all positions alike, each joint's own, and that of one that moves too far.

    None where a channel has been assigned otherwise already: factors so large come first, and beside another
    correction they stand for a spring.
    """
    if setup.assignment != trials.samples.as_measured:
        return
    search = _Search.over(setup, trials)
    if not search.joints:
        return
    alone = [search.scanned(int(place)) for place in np.flatnonzero(search.most < 0.0)]
    found = [search.scanned_alike(), *alone] if len(search.joints) > 1 else alone
    promising = [trial for trial in found if search.gain(trial) > RATIO.promising]
    for trial in promising:
        yield from search.hypothesis(conflict, search.refined_along(trial))
    if promising and len(search.joints) > 1:
        first = found[0] if promising[0] is found[0] else np.zeros(len(search.joints))
        yield from search.own_factors(conflict, first)


@dataclass(frozen=True, eq=False)
class _Search:
    """Search the logarithms of factors on the positions of joints that turn and move."""

    setup: Setup
    trials: Trials
    joints: tuple[int, ...]
    """The joints, from 0."""
    least: Vector
    most: Vector
    """Logarithms at which each of them hardly moves, and moves as far as it can."""
    present: float
    """The bound of the set-up as it is."""

    @classmethod
    def over(cls, setup: Setup, trials: Trials) -> "_Search":
        moves = trials.moves(setup)
        joints = tuple(joint for joint in setup.revolute() if moves[joint])
        positions = setup.assignment.position.of(trials.samples.position)[:, list(joints)]
        spans = np.maximum(np.ptp(positions, axis=0), np.finfo(float).tiny)
        reach = np.array([_reach(setup, joint) for joint in joints])
        least, most = np.log(UNIT.least_span / spans), np.log(reach / spans)
        return cls(setup, trials, joints, least, most, trials.bound(setup))

    @property
    def is_expected(self) -> bool:
        """Tell whether a joint moves further than joints do."""
        return bool((self.most < 0.0).any())

    def changed(self, logarithms: Vector) -> Setup:
        """Give the set-up with these factors."""
        position = self.setup.assignment.position
        for joint, logarithm in zip(self.joints, logarithms, strict=True):
            position = position.scaled(float(np.exp(logarithm)), joint)
        return self.setup.with_position(position)

    def bound(self, logarithms: Vector) -> float:
        """Give the bound with these factors, with a wall where joints cannot move so."""
        inside = np.clip(logarithms, self.least, np.maximum(self.most, self.least))
        beyond = float(np.sum((logarithms - inside) ** 2))
        return self.trials.bound(self.changed(inside)) + beyond

    def gain(self, logarithms: Vector) -> float:
        """Give by how much the mean logarithm of the errors falls."""
        return self.present - self.bound(logarithms)

    def scanned(self, place: int) -> Vector:
        """Give the best of some factors of one joint."""
        steps = np.linspace(self.least[place], max(self.most[place], self.least[place]), RATIO.steps)
        return self._best(np.outer(steps, np.arange(len(self.joints)) == place))

    def scanned_alike(self) -> Vector:
        """Give the best of some factors of all joints alike."""
        steps = np.linspace(float(self.least.min()), float(self.most.min()), RATIO.steps)
        return self._best(np.outer(steps, np.ones(len(self.joints))))

    def _best(self, trials: np.ndarray) -> Vector:
        return np.asarray(trials[int(np.argmin([self.bound(trial) for trial in trials]))], dtype=float)

    def refined_along(self, logarithms: Vector) -> Vector:
        """Refine the one factor that some joints share."""
        way, first = (logarithms != 0.0).astype(float), logarithms[np.argmax(np.abs(logarithms))]
        around = (first - RATIO.next_to, first + RATIO.next_to)
        found = minimize_scalar(
            lambda own: self.bound(own * way), bounds=around, method="bounded", options={"xatol": RATIO.fine}
        )
        return np.asarray(float(found.x) * way)

    def own_factors(self, conflict: str, first: Vector) -> Iterator[Hypothesis]:
        """Give each joint's own factor, if all together gain what as many corrections have to."""
        for place in range(len(self.joints)):
            steps = first[place] + np.linspace(-RATIO.apart, RATIO.apart, RATIO.steps)
            others = np.outer(np.ones(len(steps)), first)
            others[:, place] = steps
            first = self._best(np.vstack([first, others]))
        if self.is_expected or self.gain(first) > RATIO.promising * len(self.joints):
            found = fmin_powell(self.bound, first, xtol=RATIO.fine, ftol=RATIO.settled, disp=False)
            yield from self.hypothesis(conflict, np.atleast_1d(found))

    def hypothesis(self, conflict: str, logarithms: Vector) -> Iterator[Hypothesis]:
        """Say that the positions of the joints whose logarithm is not zero have these factors."""
        places = np.flatnonzero(logarithms)
        spans = UNIT.least_span * np.exp((logarithms - self.least)[places])
        if np.abs(logarithms).max(initial=0.0) < RATIO.least_position or spans.max() < RATIO.least_span:
            return
        alike = len(places) > 1 and bool(np.ptp(logarithms[places]) == 0.0)
        joints = tuple(self.joints[place] + 1 for place in places)
        times = np.exp(-logarithms[places][:1] if alike else -logarithms[places])
        untold = () if alike else self._untold(logarithms, places)
        if not self.is_expected and not _are_gears(times) and not _are_gears(np.degrees(times)):
            return
        known = f" (these logs do not tell the factor of {_numbered(untold)})" if untold else ""
        whose = _whose(joints)
        yield Hypothesis(
            conflict,
            joints,
            "position",
            self.changed(logarithms),
            f"the {whose} {'is' if len(joints) == 1 else 'are'} {_list(times)} times as large as the torques "
            f"require, as on the motor's side of a gear{_in_degrees(times)}{known}",
            f"read the {whose} with the scale {_list(1.0 / times)}, or the exact ratios",
            expected=self.is_expected,
            corrections=1 if alike else max(len(places) - len(untold), 1),
        )

    def _untold(self, logarithms: Vector, places: np.ndarray) -> tuple[int, ...]:
        """List the joints, from 1, whose factor these logs do not tell."""
        return tuple(
            self.joints[place] + 1 for place in places if self._deviation(logarithms, place) > RATIO.unknown
        )

    def _deviation(self, logarithms: Vector, place: int) -> float:
        """Give the standard deviation of one logarithm, by the curvature of the likelihood."""
        step = np.zeros(len(logarithms))
        step[place] = RATIO.curvature_step
        middle, *sides = (self.bound(own) for own in (logarithms, logarithms - step, logarithms + step))
        curvature = (sum(sides) - 2.0 * middle) / RATIO.curvature_step**2
        independent = self.trials.samples.independent * self.setup.joints
        return float(1.0 / np.sqrt(max(independent * curvature, np.finfo(float).tiny)))


def _reach(setup: Setup, joint: int) -> float:
    """Give how far a joint can move: between its limits, or as far as joints usually do, rad."""
    limits = setup.robot.joints[joint].limits.position
    if limits is not None:
        return limits[1] - limits[0]
    return next(unit.usual[1] for unit in POSITIONS.units if unit.name == "rad")


def _in_degrees(times: JointVector) -> str:
    """Give the ratios of motors' angles in rad that were declared as degrees, where they are a gear's."""
    ratios = np.degrees(times)
    words = f"; {_list(ratios)} times if the numbers are radians that were declared as degrees"
    return words if _are_gears(ratios) else ""


def _are_gears(ratios: JointVector) -> bool:
    """Tell whether most of them are ratios that gears of robots have: a log may not tell all."""
    least, most = RATIO.gears
    return bool(least <= np.median(ratios) <= most)


def _whose(joints: tuple[int, ...]) -> str:
    return f"{'position' if len(joints) == 1 else 'positions'} of {_numbered(joints)}"


def _numbered(joints: tuple[int, ...]) -> str:
    return f"{'joint' if len(joints) == 1 else 'joints'} {', '.join(map(str, joints))}"


def _list(values: JointVector) -> str:
    return ", ".join(f"{value:.4g}" for value in values)
