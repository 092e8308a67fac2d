"""Test whether a joint's zero is described at another angle than where it is, by profile likelihood."""

from collections.abc import Iterator

import numpy as np
from scipy.optimize import minimize_scalar

from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..thresholds import ZERO
from ..trial import Trials

_QUARTER = np.pi / 2.0
"""A quarter turn, rad."""


class ZeroOffset(Conflict):
    """Move the zero of one revolute joint by any angle but quarter turns."""

    name = "zero_offset"
    title = "Zero of a joint"

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Give the likeliest zero of every joint, if it is further off than a correction with a size."""
        moves = trials.moves(setup)
        for joint in setup.revolute():
            angle = _likeliest(setup, trials, joint) if moves[joint] else 0.0
            if abs(angle - _QUARTER * round(angle / _QUARTER)) < ZERO.least:
                continue
            degrees = float(np.degrees(angle))
            yield Hypothesis(
                self.name,
                (joint + 1,),
                "position",
                _moved(setup, joint, angle),
                f"the zero of joint {joint + 1} is about {-degrees:+.3g} degrees from the described one",
                f"add {degrees:+.4g} degrees to the position of joint {joint + 1}, or the exact angle",
            )


def _likeliest(setup: Setup, trials: Trials, joint: int) -> float:
    """Minimise what least squares leaves over an angle, rad, coarsely and then finely."""
    angles = np.array(ZERO.coarse)
    scores = np.array([_bound(setup, trials, joint, angle) for angle in angles])
    best = int(np.argmin(scores))
    if scores[angles == 0.0].item() - scores[best] < ZERO.promising:
        return 0.0
    ends = angles[best] + np.array([-ZERO.around, ZERO.around])
    found = minimize_scalar(
        lambda angle: trials.bound(_moved(setup, joint, angle)),
        bounds=ends,
        method="bounded",
        options={"xatol": ZERO.tolerance},
    )
    return float(found.x)


def _bound(setup: Setup, trials: Trials, joint: int, angle: float) -> float:
    """Give what least squares leaves at one of the angles that are tried first, kept for all."""
    return float(trials.equations(_moved(setup, joint, angle)).reduced.bound)


def _moved(setup: Setup, joint: int, angle: float) -> Setup:
    return setup.with_position(setup.assignment.position.moved(angle, joint)) if angle else setup
