"""Hide what the user has wrong about the robot: one entry of its table, or which way is down."""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from tests.plant.controller import Steering
from tests.plant.effects.effect import Effect, Hidden
from tests.plant.robots import Arm
from veritorque.core.robot.frames import rotation_x, rotation_y
from veritorque.core.robot.model import Link, RobotModel

REACH = {"alpha": 0.25, "d": 0.15, "r": 0.15}
"""Largest error of an entry, rad or m."""


@dataclass(frozen=True)
class KinematicError(Effect):
    """Let the user believe an entry (alpha, d or r) of a joint's row that is `error` below the true one."""

    entry: str
    error: float
    cause = "kinematic_error"
    draw_order = 24
    parameters = ("error",)
    units: ClassVar = {"error": "rad or m"}
    sizes = ("error",)

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a joint after the first, whose row is the robot's place in the room, and an entry."""
        joint = int(rng.integers(2, arm.joints + 1))
        return cls((joint,), str(rng.choice(list(REACH))), float(rng.choice([-0.02, 0.02])))

    def plausible(self) -> bool:
        """Stay within what an unnoticed error may be."""
        return abs(self.error) <= REACH[self.entry]

    def truth(self) -> tuple[Hidden, ...]:
        """Name the error and, as its name, the entry."""
        unit = "rad" if self.entry == "alpha" else "m"
        return tuple(Hidden(name, self.joints[0], unit, self.error) for name in ("error", self.entry))

    def believed(self, robot: RobotModel) -> RobotModel:
        """Subtract the error from the entry."""
        links = list(robot.links)
        links[self.own] = self._mistaken(links[self.own])
        return replace(robot, links=tuple(links))

    def _mistaken(self, link: Link) -> Link:
        assert link.row is not None
        row = replace(link.row, **{self.entry: getattr(link.row, self.entry) - self.error})
        rotation, translation = row.placement()
        return replace(link, row=row, rotation=rotation, translation=translation)


@dataclass(frozen=True)
class GravityMisalignment(Effect):
    """Let true gravity be the believed one, turned by tilt_x about the base's x, then by tilt_y about y."""

    tilt_x: float
    tilt_y: float
    cause = "gravity_misalignment"
    draw_order = 25
    parameters = ("tilt_x", "tilt_y")
    units: ClassVar = {"tilt_x": "rad", "tilt_y": "rad"}
    sizes = ("tilt_x", "tilt_y")
    largest = 0.4
    local = False

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a direction; a planar arm only feels a tilt about the axis it turns about."""
        angle = 0.5 * np.pi if arm.name.startswith("planar") else rng.uniform(-np.pi, np.pi)
        every = tuple(range(1, arm.joints + 1))
        return cls(every, 0.02 * float(np.cos(angle)), 0.02 * float(np.sin(angle)))

    def plausible(self) -> bool:
        """Bound the whole tilt, whichever axis it is about."""
        return bool(np.hypot(self.tilt_x, self.tilt_y) <= self.largest)

    def believed(self, robot: RobotModel) -> RobotModel:
        """Turn the true gravity back."""
        turn = rotation_y(self.tilt_y) @ rotation_x(self.tilt_x)
        return replace(robot, gravity=turn.T @ robot.gravity)
