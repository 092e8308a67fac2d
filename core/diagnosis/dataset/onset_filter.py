"""Filter what a body adds that comes within a stretch, from what it would add throughout.

Its instant is searched finely and its columns are many; away from that instant they are those of a body that
was always there, or nothing.
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
