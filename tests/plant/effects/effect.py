"""Say where an effect may act on the plant: on description, truth, friction, torque, drive or sensors.

An effect is a frozen record of its physical parameters; the engine asks it at each of these places, and by
default it changes nothing there.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from typing import ClassVar, Self

import numpy as np

from tests.plant.robots import Arm
from veritorque.core.robot.model import RobotModel


@dataclass(frozen=True)
class Hidden:
    """Name one hidden number, as a finding is expected to name it."""

    name: str
    joint: int
    unit: str
    value: float


@dataclass(eq=False)
class State:
    """Show the plant to its effects at one step; arrays count joints from 0.

    Positions and velocities are the motors', in rad and rad/s. `level` is the friction level in N m and
    `load` the torque in N m that the gears transmitted to the links at the step before: what remains of the
    drive's torque after friction, offset and the rotors' inertia.
    `jacobian` gives, 3 x joints, how a point on the last link moves with them.
    """

    step: float
    position: np.ndarray
    level: np.ndarray
    time: float = 0.0
    velocity: np.ndarray = field(default_factory=lambda: np.zeros(0))
    load: np.ndarray = field(default_factory=lambda: np.zeros(0))
    memory: dict[str, float] = field(default_factory=dict)
    jacobian: Callable[[], np.ndarray] = lambda: np.zeros((3, 0))


@dataclass(frozen=True, eq=False)
class Signals:
    """Hold what the sensors see at the log's rate, before noise, and what is true beside it.

    `position`, `velocity` and `acceleration` are the measured angle and its exact derivatives; `direction`
    is the Coulomb friction over its level, in [-1, 1] where the joint sticks; `fine_torque` is the drive's
    torque at every step of the simulation, `steps` of them per row. `encoder_step` is one count in rad per
    joint; `kept` names for every row the row that is logged in its place. Of the joints (from 0) in `silent`
    a torque of zero has no noise.
    """

    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    torque: np.ndarray
    direction: np.ndarray
    motor_direction: np.ndarray
    fine_torque: np.ndarray
    steps: int
    encoder_step: np.ndarray
    kept: np.ndarray
    temperature: np.ndarray | None = None
    silent: tuple[int, ...] = ()

    @property
    def fine_time(self) -> np.ndarray:
        """Give the instants of the simulation's steps, s."""
        return (self.time[1] - self.time[0]) / self.steps * np.arange(len(self.fine_torque))

    def with_torque(self, fine: np.ndarray) -> Self:
        """Log another torque (N m), given at every step, so that whatever acts next acts on it."""
        return replace(self, torque=fine[:: self.steps], fine_torque=fine)


@dataclass(frozen=True)
class Effect:
    """Hide nothing; every effect overrides what it changes.

    Attributes
    ----------
    joints
        The joints it belongs to, counted from 1.
    cause
        Its public name.
    draw_order
        Its position in the order in which causes are drawn, counted from 1; 0 if it is in no list.
    parameters
        Its numbers, as the public document names them.
    units
        Unit of every hidden number, by the field's name.
    sizes
        The fields that grow with its strength.
    largest
        Bound on the first of `sizes`: beyond it the effect is no longer plausible.
    tolerance
        How near to the wanted strength its size can be brought.
    local
        Whether it belongs to particular joints; if not, a finding need not name them.
    last
        Whether it acts on what the others made.
    """

    joints: tuple[int, ...]
    cause: ClassVar[str] = ""
    draw_order: ClassVar[int] = 0
    parameters: ClassVar[tuple[str, ...]] = ()
    units: ClassVar[Mapping[str, str]] = {}
    sizes: ClassVar[tuple[str, ...]] = ()
    largest: ClassVar[float] = np.inf
    tolerance: ClassVar[float] = 0.1
    local: ClassVar[bool] = True
    splits: ClassVar[bool] = False
    last: ClassVar[bool] = False
    raw: ClassVar[bool] = False

    @property
    def own(self) -> int:
        """Give the place of its first joint, counted from 0."""
        return self.joints[0] - 1

    def scaled(self, factor: float) -> Self:
        """Give the same effect, larger by a factor."""
        return replace(self, **{name: factor * getattr(self, name) for name in self.sizes})

    def plausible(self) -> bool:
        """Tell whether the effect is of a size that a real robot may have."""
        return not self.sizes or abs(getattr(self, self.sizes[0])) <= self.largest

    def truth(self) -> tuple[Hidden, ...]:
        """List the hidden numbers."""
        known = {one.name for one in fields(self)}
        return tuple(
            Hidden(name, self.joints[0], unit, float(getattr(self, name)))
            for name, unit in self.units.items()
            if name in known
        )

    def true(self, arm: Arm) -> Arm:
        """Change the true arm before it is built."""
        return arm

    def believed(self, robot: RobotModel) -> RobotModel:
        """Change what the user believes."""
        return robot

    def friction(self, state: State, level: np.ndarray) -> None:
        """Change the level of the set-valued friction, N m, in place."""

    def torque(self, state: State, torque: np.ndarray) -> None:
        """Add the torque in N m that the effect exerts on the motors, in place."""

    def transmit(self, twist: float, rate: float) -> float:
        """Give the torque in N m from motor to link, from motor minus link angle (rad) and its rate."""
        raise NotImplementedError

    def twist(self, torque: float) -> float:
        """Give motor minus link angle (rad) at which that torque in N m is transmitted at rest."""
        raise NotImplementedError

    def carried(self) -> tuple[float, tuple[float, float, float]]:
        """Give mass (kg) and mass centre (m, last link's frame) of a body taken up at the effect's `time`."""
        raise NotImplementedError

    def drive(self, command: np.ndarray) -> np.ndarray:
        """Turn the commanded torque (N m) into the applied one; the log keeps the command."""
        return command

    def sense(self, signals: Signals, rng: np.random.Generator) -> Signals:
        """Change what is measured, before noise and quantisation."""
        return signals


def moves_the_robot(effect: Effect) -> bool:
    """Tell whether an effect changes what happens, not only what is logged or believed."""
    places = ("true", "friction", "torque", "transmit", "carried", "drive")
    return any(overriding((effect,), place) for place in places)


def overriding(effects: tuple[Effect, ...], place: str) -> tuple[Effect, ...]:
    """Choose the effects that act at a place, those that must come last at the end."""
    acting = [one for one in effects if getattr(type(one), place) is not getattr(Effect, place)]
    return tuple(sorted(acting, key=lambda one: one.last))
