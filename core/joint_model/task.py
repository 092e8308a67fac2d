"""Hold what a fit of a joint takes: what acts on it, a model to begin with, and the balance of noises."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import EquationRows, Mask, Samples, Vector
from .orders import Order
from .responses import stabilised


@dataclass(frozen=True, eq=False)
class Signals:
    """Hold what acts on the joint, sample by sample; where friction holds it still, nothing does."""

    torque: Samples
    loads: EquationRows
    """Per N m of every load, samples x loads: sign of the speed, one, sine and cosine of the position."""
    on_link: Mask
    """Which loads act on the link, not on the motor."""


@dataclass(frozen=True, eq=False)
class Model:
    """Hold a model with its loads, N m or N."""

    order: Order
    coefficients: Vector
    loads: Vector

    @property
    def unknowns(self) -> Vector:
        """Give coefficients and loads."""
        return np.concatenate([self.coefficients, self.loads])

    def moved(self, step: Vector) -> "Model":
        """Give the model with other coefficients and loads, whose poles decay."""
        unknowns = self.unknowns + step
        count = len(self.coefficients)
        tail = stabilised(np.concatenate([[1.0], unknowns[: self.order.states - 1]]))[1:]
        coefficients = np.concatenate([tail, unknowns[self.order.states - 1 : count]])
        return replace(self, coefficients=coefficients, loads=unknowns[count:])


@dataclass(frozen=True, eq=False)
class Task:
    """Hold the data of a fit: time in units of `TIME_UNIT`."""

    position: Samples
    """Counted from where the joint begins, rad or m."""
    origin: float
    """Where it begins, rad or m."""
    signals: Signals
    step: float
    fitted: int
    """Rows that are fitted; later ones are held out."""
    instruments: Callable[[Model], Signals]
    """Gives what acts in a motion of the model without noise."""
    crossover: float
    """Angular frequency, rad per time unit, below which noise of the torque outweighs that of positions."""
