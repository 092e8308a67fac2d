"""Say what a cause offers that can be undone: in the robot's description, or row by row in a log.

A cause that is neither stays a term of the model. Both kinds work on plain numbers, so that a repair can be
read from a result document and done again elsewhere.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Literal

from ...arrays import JointSeries
from ...log.model import LogRows
from ...robot.model import RobotModel
from .protocol import Numbers, Site

Corrects = Literal["robot", "log", "model", "nothing"]
"""What a repair changes: the description, the log, the model (its term is all there is), or nothing."""


class CorrectsRobot:
    """Correct the robot's description."""

    def corrected_robot(self, robot: RobotModel, joints: Site, numbers: Numbers) -> RobotModel:
        """Give the robot as it is."""
        raise NotImplementedError


class CorrectsLog:
    """Correct the rows of a log."""

    def corrected_rows(self, rows: LogRows, joints: Site, numbers: Numbers) -> LogRows:
        """Give what should have been logged; the torque is the joints', whatever the log's channel is.

        The rows follow each other without a gap, and none of them only repeats the one before.
        """
        raise NotImplementedError

    def reach(self, numbers: Numbers) -> float:
        """Give how far before and after a row others have to be known, s."""
        del numbers
        return 0.0


def corrects(cause: object) -> Corrects:
    """Tell what the repair of a cause that joined the model changes."""
    if isinstance(cause, CorrectsRobot):
        return "robot"
    return "log" if isinstance(cause, CorrectsLog) else "model"


def with_torque(rows: LogRows, joints: Site, mend: Callable[[JointSeries], JointSeries]) -> LogRows:
    """Change the torque of some joints (from 1).

    Examples
    --------
    >>> import numpy as np
    >>> rows = LogRows(np.zeros(1), np.zeros((1, 2)), np.array([[4.0, 4.0]]))
    >>> with_torque(rows, (2,), lambda torque: 0.5 * torque).torque
    array([[4., 2.]])
    """
    if rows.torque is None:
        return rows
    torque = rows.torque.copy()
    own = [joint - 1 for joint in joints]
    torque[:, own] = mend(torque[:, own])
    return replace(rows, torque=torque)
