"""Hold the model of a joint with how well it is known, and what it was judged by."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import Vector
from ..errors import VeritorqueError
from ..robot.model import RobotModel
from ..simulation.control.controller_check import ControllerCheck
from .names import OrderName
from .options import JointOptions
from .orders import Quantity
from .record import JointRecord
from .refined_iv import Fitted


@dataclass(frozen=True, eq=False)
class Known:
    """Hold quantities with their standard deviations, in SI."""

    quantities: tuple[Quantity, ...]
    values: Vector
    deviations: Vector

    def at(self, name: str) -> tuple[float, float]:
        """Give value and deviation of a quantity."""
        place = [quantity.name for quantity in self.quantities].index(name)
        return float(self.values[place]), float(self.deviations[place])


@dataclass(frozen=True, eq=False)
class HeldOut:
    """Hold the errors of a model on the rows that were not fitted."""

    torque_percent: float
    """RMS error of the torque below the crossover frequency, as a share of that torque's RMS."""
    torque_fitted_percent: float
    """The same on the fitted rows."""
    innovations: Vector
    """Mean square of the innovations, block after block."""
    position_rms: float | None = None
    """RMS error of the position that is simulated under the log's controller, rad or m; None without it."""
    position_percent: float | None = None
    """The same as a share of the motion's RMS."""


@dataclass(frozen=True, eq=False)
class FoundModel:
    """Hold a fitted model and its judgement."""

    fitted: Fitted
    parameters: Known
    modes: Known
    held_out: HeldOut
    crossover_hz: float
    late: tuple[float, float]
    """By how much the torque is late in the log, and the standard deviation, s."""
    failure: VeritorqueError | None = None
    """Why the log does not show it, or no joint has it; None where it is an answer."""

    @property
    def order(self) -> OrderName:
        """Name its order."""
        return self.fitted.model.order.name


@dataclass(frozen=True, eq=False)
class NotFound:
    """Say why the steps lead to no model of an order."""

    order: OrderName
    failure: VeritorqueError


@dataclass(frozen=True, eq=False)
class JointModel:
    """Hold the answer: the models of both orders, at least one of them without a failure."""

    robot: RobotModel
    record: JointRecord
    options: JointOptions
    rigid: FoundModel
    flexible: FoundModel | NotFound | None
    """None where it was not asked for."""
    comparison: Mapping[str, object] | None
    """What tells flexible and rigid apart."""
    controller: ControllerCheck | None

    @property
    def models(self) -> tuple[FoundModel | NotFound, ...]:
        """Give both."""
        return (self.rigid,) if self.flexible is None else (self.rigid, self.flexible)


def relative_percent(known: Known) -> Vector:
    """Give standard deviations as shares of the values, %; infinite where a value is zero."""
    size = np.abs(known.values)
    return np.asarray(
        100.0 * np.divide(known.deviations, size, out=np.full(len(size), np.inf), where=size > 0.0)
    )
