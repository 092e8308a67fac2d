r"""Describe the two models of a joint: rigid, and flexible with a spring between motor and link.

The transfer functions from the motor's torque to its position are, with the motor's viscous friction fv,

    rigid     1 / (s (J s + fv))
    flexible  (Jl s^2 + d s + k) / (s (Jm Jl s^3 + ((Jm + Jl) d + Jl fv) s^2 + ((Jm + Jl) k + d fv) s + k fv))

Time is counted in units of `TIME_UNIT`, so that powers of s are of one size. Sources: Spong 1987, J. Dyn.
Syst. Meas. Control 109; De Luca & Book 2016, Springer Handbook of Robotics, ch. 11.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from ..arrays import Matrix, Vector
from .names import OrderName

TIME_UNIT: Final = 1.0 / (2.0 * np.pi * 10.0)
"""Seconds: modes of joints lie around 10 Hz."""
_DIFFERENCE: Final = 1e-6
"""Step of central differences as a share of a coefficient: between truncation and rounding in 64 bits."""


@dataclass(frozen=True)
class Quantity:
    """Name a quantity of a joint, with the unit that it has at a revolute one."""

    name: str
    symbol: str
    unit: str
    positive: bool = True
    """Whether a model without it, or with less, is none."""


COULOMB = Quantity("coulomb", "fc", "N m", positive=False)
OFFSET = Quantity("offset", "off", "N m", positive=False)
GRAVITY = (
    Quantity("gravity_sine", "gs", "N m", positive=False),
    Quantity("gravity_cosine", "gc", "N m", positive=False),
)
VISCOUS = Quantity("viscous", "fv", "N m s/rad", positive=False)
INERTIA, STIFFNESS, DAMPING = "kg m2", "N m/rad", "N m s/rad"


@dataclass(frozen=True)
class Order:
    """Describe one model: A(s) q = B(s) tau with monic A without constant term.

    Coefficients are those of A from the second on, the last left out, and those of B, highest powers first:
    as many of each.
    """

    name: OrderName
    states: int
    quantities: tuple[Quantity, ...]
    """What `physical` gives."""
    frequencies: tuple[str, ...]
    """What `modes` gives, Hz."""
    physical: Callable[[Vector], Vector]
    """Gives quantities in SI from coefficients."""
    coefficients: Callable[[Vector], Vector]
    """Gives coefficients from quantities."""
    modes: Callable[[Vector], Vector]
    """Gives frequencies from quantities."""

    def denominator(self, coefficients: Vector) -> Vector:
        """Give A."""
        return np.concatenate([[1.0], coefficients[: self.states - 1], [0.0]])

    def numerator(self, coefficients: Vector) -> Vector:
        """Give B."""
        return np.asarray(coefficients[self.states - 1 :])

    def link_numerator(self, coefficients: Vector) -> Vector:
        """Give B for a torque on the link."""
        numerator = self.numerator(coefficients).copy()
        if self.states > 2:
            numerator[0] = 0.0  # no torque on the link reaches the motor but through spring and damper
        return numerator

    def inertia(self, coefficients: Vector) -> float:
        """Give the whole inertia, on the scale of the time unit."""
        denominator, numerator = self.denominator(coefficients), self.numerator(coefficients)
        return float(denominator[self.states - 2] / numerator[-1])


def differences(function: Callable[[Vector], Vector], at: Vector) -> Matrix:
    """Give the derivative of a function, values x arguments, by central differences.

    Examples
    --------
    >>> differences(lambda x: x**2, np.array([3.0])).round(6)
    array([[6.]])
    """
    columns = []
    for place, value in enumerate(at):
        step = np.zeros(len(at))
        step[place] = _DIFFERENCE * (abs(value) or 1.0)
        columns.append((function(at + step) - function(at - step)) / (2.0 * step[place]))
    return np.column_stack(columns)


def _rigid_quantities(coefficients: Vector) -> Vector:
    decay, gain = coefficients
    return np.array([TIME_UNIT**2 / gain, TIME_UNIT * decay / gain])


def _rigid_coefficients(quantities: Vector) -> Vector:
    inertia, viscous = quantities
    return np.array([TIME_UNIT * viscous / inertia, TIME_UNIT**2 / inertia])


def _flexible_quantities(coefficients: Vector) -> Vector:
    _, second, third, gain, damped, sprung = coefficients
    motor, viscous = 1.0 / gain, third / sprung
    link = (second - damped * viscous) / sprung - motor
    stiffness, damping = link * sprung / gain, link * damped / gain
    return np.array(
        [motor * TIME_UNIT**2, link * TIME_UNIT**2, stiffness, damping * TIME_UNIT, viscous * TIME_UNIT]
    )


def _flexible_coefficients(quantities: Vector) -> Vector:
    motor, link, stiffness, damping, viscous = quantities / np.array(
        [TIME_UNIT**2, TIME_UNIT**2, 1.0, TIME_UNIT, TIME_UNIT]
    )
    both = motor * link
    return np.array(
        [
            ((motor + link) * damping + link * viscous) / both,
            ((motor + link) * stiffness + damping * viscous) / both,
            stiffness * viscous / both,
            1.0 / motor,
            damping / both,
            stiffness / both,
        ]
    )


def _flexible_modes(quantities: Vector) -> Vector:
    """Give the frequency at which motor and link swing against each other, and that of the link alone."""
    motor, link, stiffness, _, _ = quantities
    squares = stiffness * np.array([1.0 / motor + 1.0 / link, 1.0 / link])
    return np.asarray(np.sqrt(squares) / (2.0 * np.pi))


RIGID: Final = Order(
    "rigid",
    2,
    (Quantity("inertia", "J", INERTIA), VISCOUS),
    (),
    _rigid_quantities,
    _rigid_coefficients,
    lambda _: np.zeros(0),
)
FLEXIBLE: Final = Order(
    "flexible",
    4,
    (
        Quantity("motor_inertia", "Jm", INERTIA),
        Quantity("link_inertia", "Jl", INERTIA),
        Quantity("stiffness", "k", STIFFNESS),
        Quantity("damping", "d", DAMPING, positive=False),
        VISCOUS,
    ),
    ("natural", "antiresonance"),
    _flexible_quantities,
    _flexible_coefficients,
    _flexible_modes,
)
