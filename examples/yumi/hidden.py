"""Say what the simulated arm does that no standard model has: the truth behind the second log.

Two effects are hidden, of sizes that small geared arms show: the friction of joint 2 grows with the torque
that its gear transmits, and the torque of joint 4 ripples along its angle. Sources of the laws: Bittencourt &
Gunnarsson, J. Dyn. Sys. Meas. Control 134(5), 2012; Madsen et al., Robotics and Computer-Integrated
Manufacturing 61, 2020.
"""

from dataclasses import dataclass

import numpy as np

from examples.yumi import arm


@dataclass(frozen=True, eq=False)
class Hidden:
    """Hold the sizes of the hidden effects, one value per joint; zeros hide nothing.

    Attributes
    ----------
    load_coefficient
        Friction per transmitted torque, N m per N m.
    amplitude, harmonic, phase
        The drive has to give amplitude cos(harmonic q + phase) more: N m, waves per turn, rad.
    """

    load_coefficient: np.ndarray
    amplitude: np.ndarray
    harmonic: np.ndarray
    phase: np.ndarray

    def friction_level(self, load: np.ndarray) -> np.ndarray:
        """Give the level of Coulomb friction under a transmitted torque (N m), N m.

        Examples
        --------
        >>> (TWO_EFFECTS.friction_level(np.full(7, 10.0)) - arm.COULOMB).round(9).tolist()
        [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]
        """
        return np.asarray(arm.COULOMB + self.load_coefficient * np.abs(load))

    def ripple(self, position: np.ndarray) -> np.ndarray:
        """Give the torque that ripples along the angle (rad), N m."""
        return np.asarray(self.amplitude * np.cos(self.harmonic * position + self.phase))


def _only(joint: int, value: float) -> np.ndarray:
    """Give a value to one joint, counted from 1, and zero to the others."""
    return np.where(np.arange(1, arm.JOINTS + 1) == joint, value, 0.0)


NOTHING = Hidden(*(np.zeros(arm.JOINTS) for _ in range(4)))
TWO_EFFECTS = Hidden(
    load_coefficient=_only(2, 0.10), amplitude=_only(4, 0.12), harmonic=_only(4, 9.0), phase=_only(4, 0.7)
)
EFFECTS: list[dict[str, object]] = [
    {
        "cause": "friction_load_dependent",
        "joints": [2],
        "parameters": {"load_coefficient": float(TWO_EFFECTS.load_coefficient[1])},
    },
    {
        "cause": "torque_ripple",
        "joints": [4],
        "parameters": {
            "amplitude": float(TWO_EFFECTS.amplitude[3]),
            "harmonic": float(TWO_EFFECTS.harmonic[3]),
            "phase": float(TWO_EFFECTS.phase[3]),
        },
    },
]
"""The same in the words of a diagnosis."""
