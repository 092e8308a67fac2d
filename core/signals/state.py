"""Carry the motion of all joints at the same instants: what every torque effect is computed from."""

from dataclasses import dataclass

from ..arrays import JointSeries, Samples


@dataclass(frozen=True, eq=False)
class MotionState:
    """Carry position (rad or m), velocity (per s) and acceleration (per s2) of all joints.

    Attributes
    ----------
    time
        The instants, s, on the log's own clock; None where only the configuration matters.
    temperature
        Temperature of every joint, degC; None where none was logged.
    """

    position: JointSeries
    velocity: JointSeries
    acceleration: JointSeries
    time: Samples | None = None
    temperature: JointSeries | None = None
