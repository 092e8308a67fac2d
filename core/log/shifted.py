"""Give the rows of a log with the efforts of a little later: what a channel that lags shows only then."""

from dataclasses import replace
from functools import partial

import numpy as np
from scipy.interpolate import CubicSpline

from ..arrays import JointSeries
from .corrected import FEWEST, CorrectedSource
from .model import JointLog, LogRows


def with_later_effort(log: JointLog, seconds: float) -> JointLog:
    """Give every row the torque or current of so many seconds later; constant beyond a stretch's end."""
    if seconds == 0.0:
        return log
    reach = int(np.ceil(abs(seconds) * log.rate_hz))
    return replace(log, source=CorrectedSource(log, partial(_later, seconds), reach), sha256="")


def _later(seconds: float, rows: LogRows) -> LogRows:
    if len(rows.time) < FEWEST:
        return rows
    then = np.clip(rows.time + seconds, rows.time[0], rows.time[-1])
    torque, current = (
        None if values is None else _at(then, rows, values) for values in (rows.torque, rows.current)
    )
    return replace(rows, torque=torque, current=current)


def _at(time: np.ndarray, rows: LogRows, values: JointSeries) -> JointSeries:
    return np.asarray(CubicSpline(rows.time, values)(time))
