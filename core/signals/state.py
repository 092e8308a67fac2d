"""Carry the motion of all joints at the same instants: what every torque effect is computed from."""

from dataclasses import dataclass

from core.arrays import JointSeries


@dataclass(frozen=True, eq=False)
class MotionState:
    """Carry position (rad or m), velocity (per s) and acceleration (per s2) of all joints."""

    position: JointSeries
    velocity: JointSeries
    acceleration: JointSeries
