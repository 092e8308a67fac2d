"""Define what every torque effect must offer, so that a new effect is one file and later chapters stay.

A term is linear in its parameters. It says which (joint, parameter) pairs can differ from zero and gives one
time series for each of them; everything that is structurally zero is never computed, filtered or stored.
"""

from typing import ClassVar, Protocol, runtime_checkable

from ..arrays import Series
from ..robot.model import RobotModel
from ..robot.parameters import Parameter
from ..signals.state import MotionState

Entry = tuple[int, int]
"""Joint row and parameter column, both counted from 0 within the term."""


@runtime_checkable
class Term(Protocol):
    """Offer the columns of one torque effect.

    Attributes
    ----------
    remembers
        Whether the torque depends on the motion before the instant, and not on the instant alone.
    channel
        Whether the torque is only logged and moves nothing: a fault of the torque channel.
    loads
        Whether it acts on the links, so that the gears transmit it.
    """

    remembers: ClassVar[bool]
    channel: ClassVar[bool]
    loads: ClassVar[bool]

    @property
    def name(self) -> str:
        """Name the effect as options and results spell it."""
        ...

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List the parameters the effect has on this robot."""
        ...

    def entries(self, robot: RobotModel) -> tuple[Entry, ...]:
        """List the (joint, parameter) pairs whose series can differ from zero."""
        ...

    def series(self, robot: RobotModel, state: MotionState) -> Series:
        """Give the torque per unit parameter, one row per entry (N m or N per unit of the parameter)."""
        ...
