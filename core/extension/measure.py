"""Measure what an extended model gains on held-out blocks: in torque, and in simulated motion."""

from dataclasses import replace

from ..arrays import Parameters
from ..diagnosis.result import Diagnosis
from ..dynamics.model import DynamicModel
from ..errors import VeritorqueError
from ..estimate.problem import Problem
from ..identification.result import Identification
from ..simulation.mechanism import mechanism_of
from ..simulation.multistep import Comparison, compare
from .cure import input_note
from .fold import fold
from .gain import gains, worsens_motion
from .result import Extension


def measure_gains(without: Extension, after: Identification, problem: Problem) -> Extension:
    """Measure what the extended model gains, and leave it out where simulated motion becomes worse."""
    before, held = without.before, without.before.observation.parts(problem.held_out)[1]
    old = before.estimate if without.compared is None else without.compared
    gained = gains((before.observation, old.base), (after.observation, after.estimate.base), held)
    motion, note = _motion((problem.base.model, old.standard), after, without.diagnosis, problem)
    if motion is not None and worsens_motion(motion):
        note = "the correction makes the simulated motion clearly worse, and was not applied"
        return replace(without, motion_note=note)
    return replace(without, after=after, gains=gained, motion=motion, motion_note=note)


def _motion(
    before: tuple[DynamicModel, Parameters], after: Identification, found: Diagnosis, problem: Problem
) -> tuple[Comparison | None, str]:
    """Simulate the held-out blocks with both models, and say which findings are not part of the motion."""
    try:
        old, new = mechanism_of(*before), mechanism_of(*fold(after.base.model, after.estimate.standard))
        return compare(old, new, problem.motions, chosen=problem.held_out or None), input_note(found)
    except VeritorqueError as error:
        return None, str(error)
