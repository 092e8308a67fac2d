"""Play a drive from its first instant to its last and write the motion down."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .drive import Drive
from .integrate import LONGEST_STEP, Integrator
from .mechanism import Mechanism
from .stage import States, drag_of

Progress = Callable[[float], None]


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Hold simulated motion at the drive's instants: (instants, joints, states).

    Position is in rad or m, velocity per s, torque (feedback included) in N m or N.
    """

    position: np.ndarray
    velocity: np.ndarray
    torque: np.ndarray


def rollout(
    mechanism: Mechanism,
    start: States,
    drive: Drive,
    *,
    longest_step: float = LONGEST_STEP,
    progress: Progress | None = None,
) -> Trajectory:
    """Simulate from the starting states to the drive's last instant.

    Raises
    ------
    SolverError
        If the motion diverges or the robot cannot be accelerated.
    """
    integrator = Integrator(mechanism, drive, drag_of(mechanism, start), longest_step)
    torque = drive.torque if drive.feedback is None else np.empty_like(drive.torque)
    found = Trajectory(np.empty_like(torque), np.empty_like(torque), torque)
    states = start
    for number in range(drive.steps + 1):
        found.position[number], found.velocity[number] = states.position, states.velocity
        if drive.feedback is not None:
            torque[number] = drive.played(number, states)
        if number < drive.steps:
            states = integrator.advance(states, number)
        if progress is not None:
            progress(number / max(drive.steps, 1))
    return found
