"""Make joints of a problem flexible, with a filter that follows their modes.

The first estimate takes the links to be where the torques say they are. Far above a mode noise outweighs the
motion, and far below it a spring hardly shows: the band follows the modes that are found.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from ..arrays import Vector
from ..dynamics.terms.flexible_joints import DAMPING, STIFFNESS, FlexibleJoints
from ..errors import ExcitationError, OptionError, VeritorqueError
from ..estimate.flexible_start import FlexibleStart, begin, standard_of
from ..estimate.problem import Problem
from ..reduction.base import base_model
from ..signals.condition import Motion, condition
from ..signals.recipe import FilterOptions
from ..simulation.closed_loop.springs import links_of
from ..simulation.mechanism import mechanism_of
from ..validation.springs_seen import HIGHEST_SHARE, reasons_unseen
from .spring_evidence import BAND_OVER_MODE, misfiltered, positions_of, refuse_hidden, seen_by, unseen

POSITIONS_OVER_BAND: Final = 3.0
"""Cut-off of positions over that: it bends what passes by less than 1e-5."""
SETTLED: Final = 0.15
"""Relative change of the band below which it follows the modes."""
BANDS: Final = (1.0, 2.5, 6.0)
"""Bands that are begun with, as multiples of the motion's: near the mode a spring shows most clearly."""
ROUNDS: Final = 6
"""Bands at most from each beginning: from a tenth of the mode each round finds more of it."""


def with_springs(problem: Problem, joints: tuple[int, ...], options: FilterOptions) -> FlexibleStart:
    """Give the problem in which these joints are flexible, and where it begins.

    Raises
    ------
    ExcitationError
        If the logs do not show that they are.
    """
    check_moved(problem.motions, joints)
    own = replace(problem, base=base_model(problem.base.model.with_term(FlexibleJoints(joints))))
    if options.cutoff_hz is None:
        return _sized(_found(own, options))
    return _sized(_within(own, options, options.cutoff_hz))


def check_moved(motions: Sequence[Motion], joints: tuple[int, ...]) -> None:
    """Refuse flexible joints that stand all the time in a log, or whose torque was not measured.

    Raises
    ------
    ExcitationError
        If there are such joints.
    """
    for motion in motions:
        unmeasured = motion.segments[0].unmeasured
        for marks, own, all_of_them in (
            (motion.recipe.held, "it stands", "they stand"),
            (unmeasured, "its torque was not measured", "their torques were not measured"),
        ):
            hidden = [joint for joint in joints if marks[joint - 1]]
            if hidden:
                why = own if len(hidden) == 1 else all_of_them
                raise unseen(hidden, {"joints": hidden, "log": motion.log.name}, why)


def _found(problem: Problem, options: FilterOptions) -> FlexibleStart:
    """Begin with the first of some bands that shows all springs."""
    band = max(motion.recipe.motion_band_hz for motion in problem.motions)
    failures, tried = list[VeritorqueError](), list[float]()
    for share in BANDS:
        try:
            begun = _followed(problem, options, share * band, tried)
            if begun is not None:
                return _checked(begun)
        except (ExcitationError, OptionError) as error:
            failures.append(error)
    raise failures[0]


def _within(problem: Problem, options: FilterOptions, cutoff_hz: float) -> FlexibleStart:
    """Begin with the filter that was asked for; where another one shows the springs, say which.

    A filter below the mode is refused: the spring that explains what it passes may be several times too soft.
    """
    try:
        begun = _checked(begin(problem))
        _check_passes(begun, cutoff_hz)
    except ExcitationError as hidden:
        try:
            shown = _found(problem, replace(options, cutoff_hz=None))
        except (ExcitationError, OptionError):
            raise hidden from None
        raise misfiltered(hidden, cutoff_hz, float(np.max(_modes(shown)[1]))) from None
    return begun


def _check_passes(begun: FlexibleStart, cutoff_hz: float) -> None:
    """Refuse a filter that does not pass the modes."""
    joints, high = begun.transmission.joints + 1, _modes(begun)[1]
    hidden = [int(joint) for joint, mode in zip(joints, high, strict=True) if mode > cutoff_hz]
    if hidden:
        evidence = {"joints": hidden, "natural_hz": high[high > cutoff_hz].tolist(), "cutoff_hz": cutoff_hz}
        raise unseen(hidden, evidence, "the filter does not pass the mode")


def _followed(
    problem: Problem, options: FilterOptions, band: float, tried: list[float]
) -> FlexibleStart | None:
    """Begin with a band, and let it follow the modes that are found, but not below the motion.

    None where it comes to a band that was tried: what is found depends on the band alone.
    """
    least = max(motion.recipe.motion_band_hz for motion in problem.motions)
    most = HIGHEST_SHARE * max(motion.log.rate_hz for motion in problem.motions)
    before, begun = tuple(tried), None
    for _ in range(ROUNDS):
        if any(abs(band - other) <= SETTLED * other for other in before):
            return None
        tried.append(band)
        begun = begin(replace(problem, motions=_conditioned(problem, options, band)))
        wanted = min(max(BAND_OVER_MODE * float(np.max(_modes(begun)[1])), least), most)
        if abs(wanted - band) <= SETTLED * band:
            return begun
        band = wanted
    tried.pop()  # it has not settled, and another beginning may go on from there
    return begun


def _conditioned(problem: Problem, options: FilterOptions, band_hz: float) -> tuple[Motion, ...]:
    """Condition the logs anew, with a filter that passes so much."""
    robot = problem.base.model.robot

    def within(motion: Motion) -> FilterOptions:
        rate = motion.log.rate_hz
        band = min(band_hz, HIGHEST_SHARE * rate)
        positions = options.position_cutoff_hz or min(POSITIONS_OVER_BAND * band, 0.4 * rate)
        return replace(options, cutoff_hz=band, position_cutoff_hz=positions)

    return tuple(
        condition(motion.log, robot, within(motion), blocks=motion.blocks, number=number)
        for number, motion in enumerate(problem.motions)
    )


def _modes(begun: FlexibleStart) -> tuple[Vector, Vector]:
    """Give every spring's antiresonance and natural frequency, Hz; infinite where an inertia is negative."""
    problem, own = begun.problem, begun.transmission
    mechanism = links_of(mechanism_of(problem.base.model, standard_of(problem, begun.base)))
    mass = mechanism.mass_matrices(positions_of(problem))
    link = np.median(np.diagonal(mass, axis1=1, axis2=2), axis=0)[own.joints]
    squares = np.where(link > 0.0, own.stiffness / np.where(link > 0.0, link, 1.0), np.inf)
    return np.sqrt(squares) / (2.0 * np.pi), np.sqrt(squares + own.stiffness / own.rotor) / (2.0 * np.pi)


def _checked(begun: FlexibleStart) -> FlexibleStart:
    """Refuse at once springs that the sampling or the torque hides: they would be simulated to no end."""
    low, high = _modes(begun)
    joints = [int(joint) for joint in begun.transmission.joints]
    evidence = {
        joint + 1: seen_by(begun.problem.motions, joint, float(at), float(mode))
        for joint, at, mode in zip(joints, low, high, strict=True)
    }
    refuse_hidden(evidence, {joint: _hidden_by(own) for joint, own in evidence.items()})
    return begun


def _hidden_by(evidence: Mapping[str, float]) -> list[str]:
    """Say what hides a spring; a link without inertia has no mode."""
    if "natural_hz" not in evidence:
        return ["the link behind its spring would have no inertia"]
    return list(reasons_unseen(evidence))


def _sized(begun: FlexibleStart) -> FlexibleStart:
    """Say what counts as one unit of a spring in a prior."""
    own, sizes = begun.transmission, dict(begun.problem.sizes)
    for joint, stiffness, rotor in zip(own.joints, own.stiffness, own.rotor, strict=True):
        sizes[f"{STIFFNESS}{joint + 1}"] = float(stiffness)
        sizes[f"{DAMPING}{joint + 1}"] = float(np.sqrt(stiffness * rotor))
    return replace(begun, problem=replace(begun.problem, sizes=sizes))
