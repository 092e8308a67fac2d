"""Replay a log: the measured torque drives the robot, and a soft controller pulls it to the measured motion.

What the controller adds is what the model lacks, so no controller of the real robot has to be known. The
motion that comes out holds little of the measured motion's noise, which the controller damps.
"""

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import JointSeries
from ..control.control_law import ControlLaw, Gains, Inputs
from ..mechanism import Mechanism
from .simulated import Piece


@dataclass(frozen=True, eq=False)
class Replay:
    """Drive a robot by the torque of the log, with gains that pull it to the log's motion.

    A joint whose torque was not measured is driven by the model's own torque along the measured motion.
    """

    gains: Gains
    mechanism: Mechanism

    def law(self, step: float) -> ControlLaw:  # noqa: ARG002  (acts at every step of the integration)
        """Pull every joint to the measured motion."""
        return ControlLaw.of_joints(self.gains)

    def of(self, mechanism: Mechanism) -> "Replay":
        """Give the same gains with the torque of another robot where none was measured."""
        return replace(self, mechanism=mechanism)

    def inputs(self, piece: Piece) -> Inputs:
        """Give the measured torque and motion."""
        torque, silent = piece.torque, piece.segment.unmeasured
        if silent.any():
            torque = np.where(silent, self.mechanism.torque(piece.state), torque)
        return Inputs(torque, piece.state.position, piece.state.velocity)


def default_gains(mechanism: Mechanism, position: JointSeries, bandwidth_hz: float) -> Gains:
    """Damp every joint critically at a bandwidth, for the median inertia it sees on its way."""
    inertia = np.median(np.diagonal(mechanism.mass_matrices(position), axis1=1, axis2=2), axis=0)
    rate = 2.0 * np.pi * bandwidth_hz
    return Gains(inertia * rate**2, 2.0 * inertia * rate)
