"""Test whether the torque holds little or no gravity: a controller's own compensation was subtracted from it.

A first moment gives a torque at rest and, by the motion, another one. Both together tell how much of gravity
a torque holds, whatever the moments are.
"""

from collections.abc import Iterator

import numpy as np

from ...arrays import Vector3
from ...dynamics.terms.rotor_inertia import RotorInertia
from ..conflict import Conflict, Hypothesis
from ..path import Margins
from ..setup import Setup
from ..thresholds import COMPENSATION
from ..trial import Trials


class GravityCompensated(Conflict):
    """Leave out most of gravity, or all of it."""

    name = "gravity_compensated"
    title = "Torque without gravity"
    doubtful_causes = frozenset(
        {
            "friction_position_dependent",
            "friction_load_dependent",
            "spring_compensator",
            "cable_force",
            "gravity_misalignment",
            "encoder_offset",
            "kinematic_error",
            "link_parameters",
        }
    )
    """Gears transmit the load that such a torque does not hold: its friction follows the position. What
    a controller's wrong bodies leave of gravity follows it, too."""

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Give the likeliest share of gravity that is left, where there is gravity.

        It is significant where least squares fits so much better.
        """
        described = np.asarray(setup.robot.gravity, dtype=float)
        if not np.any(described):
            return
        share, is_significant = _likeliest_share(setup, trials, described)
        gravity = share * described + 0.0  # no negative zeros
        listed = ", ".join(f"{component:.3g}" for component in gravity)
        yield Hypothesis(
            self.name,
            (),
            "torque",
            setup.with_gravity(gravity),
            _statement(share),
            f"set gravity to [{listed}] m/s2 for this log, or log the whole torque",
            is_significant=is_significant,
        )


def _likeliest_share(setup: Setup, trials: Trials, described: Vector3) -> tuple[float, bool]:
    """Give the share of gravity that least squares finds, and whether it is surely not all of it.

    A rotor's inertia that is not modelled moves without weight, as if gravity were less. Then, and where no
    share below the largest is likeliest, none or all of gravity are the only choices.
    """
    bound = trials.under_gravity(setup)
    shares = np.linspace(-COMPENSATION.most, COMPENSATION.most, COMPENSATION.steps)
    scores = bound(shares[:, None] * described)
    margins = Margins(trials.samples.independent * setup.joints)
    best = int(np.argmin(scores))
    if best in (0, len(shares) - 1) or not _has_all_rotors(setup, trials):
        return 0.0, False
    is_significant = bool(scores[best] < bound(described) - margins.undecided)
    is_none = bool(bound(0.0 * described) <= scores[best] + margins.equal)
    return 0.0 if is_none else float(shares[best]), is_significant


def _has_all_rotors(setup: Setup, trials: Trials) -> bool:
    """Tell whether every joint's rotor has an inertia of its own in the model."""
    parameters = trials.equations(setup).regressor.base.model.parameters
    rotors = {one.number for one in parameters if one.symbol == RotorInertia.symbol[0]}
    return len(rotors) == setup.joints


def _statement(share: float) -> str:
    if not share:
        return "the torque holds no gravity"
    if share > 0.0:
        return f"the torque holds about {100.0 * share:.0f} % of gravity"
    return f"about {100.0 * (1.0 - share):.0f} % of gravity was taken from the torque, more than all of it"
