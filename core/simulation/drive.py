"""Say what drives the joints: a torque sampled on a clock, and a controller that may correct it."""

from dataclasses import dataclass

import numpy as np

from .stage import States


@dataclass(frozen=True, eq=False)
class Feedback:
    """Pull joints towards a reference."""

    stiffness: np.ndarray
    damping: np.ndarray
    """Gains per joint, N m/rad and N m s/rad (N/m, N s/m)."""
    position: np.ndarray
    velocity: np.ndarray
    """The reference at the drive's instants: (instants, joints, states)."""


@dataclass(frozen=True, eq=False)
class Drive:
    """Drive many states at once."""

    step: float
    """Time between two instants, s."""
    torque: np.ndarray
    """N m or N at the instants: (instants, joints, states); linear in between."""
    feedback: Feedback | None = None
    """What corrects it; None where nothing does."""

    @property
    def steps(self) -> int:
        """Count the steps."""
        return len(self.torque) - 1

    def at(self, number: int, share: np.ndarray, lanes: np.ndarray | None, states: States) -> np.ndarray:
        """Give the torque after a share of a step, less the feedback's damping, which is taken implicitly."""
        torque = _between(self.torque, number, share, lanes)
        if self.feedback is None:
            return torque
        back = self.feedback
        error = _between(back.position, number, share, lanes) - states.position
        wanted = _between(back.velocity, number, share, lanes)
        return np.asarray(torque + back.stiffness[:, None] * error + back.damping[:, None] * wanted)

    def played(self, number: int, states: States) -> np.ndarray:
        """Give the torque at an instant, feedback included, N m or N."""
        if self.feedback is None:
            return np.asarray(self.torque[number])
        back = self.feedback
        error = back.position[number] - states.position
        slip = back.velocity[number] - states.velocity
        return np.asarray(
            self.torque[number] + back.stiffness[:, None] * error + back.damping[:, None] * slip
        )


def _between(table: np.ndarray, number: int, share: np.ndarray, lanes: np.ndarray | None) -> np.ndarray:
    if lanes is None and (share == share[0]).all() and share[0] in {0.0, 1.0}:
        return np.asarray(table[number + int(share[0])])
    before, after = table[number], table[number + 1]
    if lanes is not None:
        before, after = np.take(before, lanes, axis=1), np.take(after, lanes, axis=1)
    return np.asarray(before + share * (after - before))
