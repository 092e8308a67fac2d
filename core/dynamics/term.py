"""Define what every torque effect offers, so that a new effect is one file.

A term is linear in its parameters. It lists the (joint, parameter) pairs that can differ from zero and gives
one time series for each; structural zeros are never computed, filtered or stored.
"""

from typing import ClassVar, Protocol, runtime_checkable

from ..arrays import Series
from ..robot.model import Parameter, RobotModel
from ..signals.state import MotionState

Entry = tuple[int, int]
"""Joint row and parameter column, both counted from 0 within the term."""


@runtime_checkable
class Term(Protocol):
    """Define the columns of one torque effect."""

    has_memory: ClassVar[bool] = False
    """Whether the torque depends on the motion before the instant."""
    channel: ClassVar[bool] = False
    """Whether the torque is an error of the torque channel, which moves nothing."""
    loads: ClassVar[bool] = False
    """Whether it acts on the links, so that transmissions carry it."""
    shapes_motion: ClassVar[bool] = False
    """Whether its parameters show in the motion of the links alone, and have no column."""

    @property
    def name(self) -> str:
        """Name the effect as options and results spell it."""

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List the parameters the effect has on this robot."""

    def entries(self, robot: RobotModel) -> tuple[Entry, ...]:
        """List the (joint, parameter) pairs whose series can differ from zero."""

    def series(self, robot: RobotModel, state: MotionState) -> Series:
        """Give the torque per unit parameter, one row per entry (N m or N per unit of the parameter)."""


def is_linearised(term: Term) -> bool:
    """Tell whether a term's columns depend on the prediction that the model is linearised at.

    Such a term holds that prediction, by the name that its key has in model files.
    """
    return hasattr(term, "believed")
