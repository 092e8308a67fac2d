"""Define causes that can be corrected: in the robot's description, or row by row in a log.

Any other cause remains a term of the model. Corrections work on plain numbers, so that a repair can be read
from a result document and repeated elsewhere.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Literal

from ...arrays import JointSeries
from ...log.model import LogRows
from ...robot.model import RobotModel
from .protocol import Numbers, Site

Corrects = Literal["robot", "log", "model", "nothing"]
"""What a repair changes: the description, the log, the model (by its term), or nothing."""


class CorrectsRobot:
    """Correct the robot's description."""

    def corrected_robot(self, robot: RobotModel, joints: Site, numbers: Numbers) -> RobotModel:
        """Give the corrected description."""
        raise NotImplementedError


class CorrectsLog:
    """Correct the rows of a log."""

    def corrected_rows(self, rows: LogRows, joints: Site, numbers: Numbers) -> LogRows:
        """Give the corrected rows; the torque is the joints', whatever the log's channel is.

        The rows have no gap, and none of them repeats the one before.
        """
        raise NotImplementedError

    def reach(self, numbers: Numbers) -> float:
        """Give the time before and after a row over which others have to be known, s."""
        del numbers
        return 0.0


def corrects(cause: object) -> Corrects:
    """Tell what the repair of a cause changes."""
    if isinstance(cause, CorrectsRobot):
        return "robot"
    return "log" if isinstance(cause, CorrectsLog) else "model"


def with_torque(rows: LogRows, joints: Site, correct: Callable[[JointSeries], JointSeries]) -> LogRows:
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
    torque[:, own] = correct(torque[:, own])
    return replace(rows, torque=torque)
