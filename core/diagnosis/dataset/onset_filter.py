"""Filter the columns of a payload from its onset, from those of a payload that is always there.

Its onset is searched finely and its columns are many. Away from the onset they equal those of a payload that
is always there, or zero.
"""

from functools import lru_cache

import numpy as np

from ...arrays import KeptSeries, Series
from ...dynamics.terms.payload_change import Payload
from ...robot.model import RobotModel
from .stretch import Stretch


def onset_rows(body: Payload, robot: RobotModel, stretch: Stretch) -> KeptSeries:
    """Give the filtered series of a body."""
    time = stretch.state.time
    begin = 0 if time is None else int(np.searchsorted(time, body.begin))
    return stretch.begun(*_throughout(robot, body.link, stretch), begin)


@lru_cache(maxsize=8)
def _throughout(robot: RobotModel, link: int, stretch: Stretch) -> tuple[Series, KeptSeries]:
    """Give the series of a body that was there all along, and what filtering them gives."""
    series = Payload(0, link, -np.inf).series(robot, stretch.state)
    return series, stretch.filtered(series)
