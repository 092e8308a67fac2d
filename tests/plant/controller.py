"""Steer an arm along a motion as a joint controller does: feed-forward of the clean arm, and PD.

The friction's feed-forward turns round gradually, so that joints stick for some milliseconds when they
reverse, as they do where nobody compensates friction perfectly.
"""

from dataclasses import dataclass

import numpy as np

from tests.plant.excitation import Excitation
from tests.plant.mechanism import STEPS_PER_SECOND, build, inertia, inverse
from tests.plant.robots import Arm

BANDWIDTH = 2.0 * np.pi * 6.0
"""Bandwidth of the joint controller, rad/s."""
DAMPING_RATIO = 0.8
EASE = 0.02
"""Share of a joint's top speed over which the controller's feed-forward of Coulomb friction turns round."""


@dataclass(frozen=True, eq=False)
class Steering:
    """Hold a joint controller: its command is the clean arm's feed-forward plus gains times reference.

    `nominal` is the feed-forward alone, N m: the torque that the motion needs where nothing is hidden.
    """

    centre: np.ndarray
    command: np.ndarray
    nominal: np.ndarray
    gain: np.ndarray
    damping: np.ndarray


def steer(arm: Arm, excitation: Excitation, rate_hz: float = 250.0) -> Steering:
    """Tune PD gains to the arm's inertia and compute its feed-forward along the motion.

    The rigid-body part is computed at the log's rate and interpolated.
    """
    model = build(arm)
    coarse = np.arange(0.0, excitation.duration + 1.5 / rate_hz, 1.0 / rate_hz)
    rigid = inverse(model, excitation.at(coarse))
    fine = np.arange(round(excitation.duration * STEPS_PER_SECOND)) / STEPS_PER_SECOND
    position, velocity, acceleration = excitation.at(fine)
    nominal = np.column_stack([np.interp(fine, coarse, column) for column in rigid.T])
    nominal += arm.rotor_inertia * acceleration + arm.viscous * velocity + arm.offset
    nominal += arm.coulomb * np.tanh(velocity / (EASE * arm.speed))
    moved = inertia(model, excitation.centre) + arm.rotor_inertia
    for coupling, (rotor, viscous, coulomb) in zip(arm.robot.couplings, arm.motors, strict=True):
        joints, weights = np.array(coupling.joints) - 1, np.array(coupling.weights)
        rate = velocity[:, joints] @ weights
        motor = rotor * acceleration[:, joints] @ weights + viscous * rate
        motor += coulomb * np.tanh(rate / (EASE * arm.speed[joints].sum()))
        nominal[:, joints] += motor[:, None] * weights
        moved[joints] += rotor * weights**2
    gain, damping = moved * BANDWIDTH**2, 2.0 * DAMPING_RATIO * moved * BANDWIDTH
    command = nominal + gain * position + damping * velocity
    return Steering(excitation.centre, command, nominal, gain, damping)
