"""Hide what is in nobody's list, so that the answer `unexplained` can be earned."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from tests.plant.controller import Steering
from tests.plant.effects.drive import torque_rms
from tests.plant.effects.effect import Effect, State
from tests.plant.robots import Arm


@dataclass(frozen=True)
class _Foreign(Effect):
    """Hold a size in N m (at the motion's typical speed) and another joint that has its say."""

    size: float
    other: int
    number: float
    sizes = ("size",)

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw two joints, a size and a number between 0 and 1."""
        joint, other = (int(one) for one in rng.permutation(arm.joints)[:2] + 1)
        return cls((joint,), 0.1 * torque_rms(steering, joint - 1), other - 1, rng.random())


class SpeedProduct(_Foreign):
    """Resist with the product of two joints' speeds, on a joint where no rigid body would."""

    cause = "foreign_speed_product"

    def torque(self, state: State, torque: np.ndarray) -> None:
        """Resist."""
        torque[self.own] -= self.size * state.velocity[self.own] * state.velocity[self.other]


class FrictionByOther(_Foreign):
    """Let the friction level follow another joint's angle."""

    cause = "foreign_friction_by_other_joint"

    def friction(self, state: State, level: np.ndarray) -> None:
        """Change the level."""
        level[self.own] += self.size * np.cos(2.0 * state.position[self.other] + 2.0 * np.pi * self.number)


class DragByOther(_Foreign):
    """Resist with the speed squared times a wave over another joint's angle, pushing as often as pulling."""

    cause = "foreign_drag_by_other_joint"

    def torque(self, state: State, torque: np.ndarray) -> None:
        """Resist."""
        velocity = state.velocity[self.own]
        wave = np.cos(2.0 * state.position[self.other] + 2.0 * np.pi * self.number)
        torque[self.own] -= self.size * velocity * abs(velocity) * wave


class Slosh(_Foreign):
    """Carry a mass that swings by itself at 1 to 3 Hz, damped by a twentieth, and pulls at the joint."""

    cause = "foreign_slosh"

    def torque(self, state: State, torque: np.ndarray) -> None:
        """Drive the swing by the joint's acceleration and feel its spring."""
        rate = 2.0 * np.pi * (1.0 + 2.0 * self.number)
        memory, velocity = state.memory, float(state.velocity[self.own])
        pushed = (velocity - memory.get("slosh before", velocity)) / state.step
        memory["slosh before"] = velocity
        angle, turn = memory.get("slosh angle", 0.0), memory.get("slosh rate", 0.0)
        turn += state.step * (-(rate**2) * angle - 0.1 * rate * turn - pushed)
        memory["slosh rate"], memory["slosh angle"] = turn, angle + state.step * turn
        torque[self.own] += self.size * memory["slosh angle"]


class Telegraph(_Foreign):
    """Switch a torque between plus and minus at random instants, once a second on average."""

    cause = "foreign_telegraph"

    def torque(self, state: State, torque: np.ndarray) -> None:
        """Switch by a hash of the time, so that every run switches alike."""
        slot = int(state.time / 0.25)
        if state.memory.get("telegraph slot") != slot:
            rng = np.random.default_rng([slot, int(1e9 * self.number)])
            turn = -1.0 if rng.random() < 0.25 else 1.0
            state.memory["telegraph slot"] = slot
            state.memory["telegraph side"] = turn * state.memory.get("telegraph side", 1.0)
        torque[self.own] -= self.size * state.memory["telegraph side"]


class Sawtooth(_Foreign):
    """Let a torque rise and drop with a period of 2 to 5 s, whatever the robot does."""

    cause = "foreign_sawtooth"

    def torque(self, state: State, torque: np.ndarray) -> None:
        """Rise evenly, drop at once."""
        period = 2.0 + 3.0 * self.number
        torque[self.own] -= self.size * (2.0 * (state.time / period % 1.0) - 1.0)
