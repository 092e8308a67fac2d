"""Fit a robot with springs between motors and links, and say what is known of every spring.

The first estimate takes the links to be where the torques say they are. Then the log is simulated with motors
and links apart.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import JointVector
from ..dynamics.terms.flexible_joints import FlexibleJoints
from ..estimate.flexible_start import FlexibleStart, begin
from ..estimate.problem import Problem
from ..reduction.base import base_model


def with_springs(problem: Problem, joints: tuple[int, ...]) -> FlexibleStart:
    """Give the problem in which these joints are flexible, and where it begins.

    Raises
    ------
    ExcitationError
        If the logs do not show that they are.
    """
    model = problem.base.model.with_term(FlexibleJoints(joints))
    begun = begin(replace(problem, base=base_model(model)))
    own = begun.transmission(begun.base)
    sizes = dict(problem.sizes)
    for joint, stiffness, rotor in zip(joints, own.stiffness, own.rotor, strict=True):
        sizes[f"KS{joint}"] = float(stiffness)
        sizes[f"DS{joint}"] = float(np.sqrt(stiffness * rotor))
    return replace(begun, problem=replace(begun.problem, sizes=sizes))
