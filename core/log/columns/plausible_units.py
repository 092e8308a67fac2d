"""Rank the units in which a column could plausibly be, with the numbers that support each; never decide.

A column of positions that spans 340 is degrees to any reader, yet a silent conversion would hide the one case
where it is not. So the readings are ranked and shown, and the user declares one.
"""

from collections.abc import Sequence

import numpy as np

from ...arrays import Vector
from ...errors import LogError
from ..channels import CHANNELS, TIME
from ..formats.table import Table

GROWING = 0.9
"""A clock goes on over at least this share of its steps, though a recorder starts anew or rows overtake."""


def plausible_readings(channel: str, values: Vector) -> list[str]:
    """Rank the units in which these values make sense.

    Parameters
    ----------
    channel
        One of `CHANNELS`.
    values
        Samples of one column, in the unit that is asked for.

    Returns
    -------
    list of str
        One sentence per plausible unit, the most plausible first; empty if none is.

    Examples
    --------
    >>> plausible_readings("position", np.array([-170.5, 169.5]))[0]
    'deg: values reach 170.5 and span 340; a revolute joint moves some hundred degrees'
    """
    finite = values[np.isfinite(values)]
    if len(finite) < (2 if channel == TIME else 1):
        return []
    if channel == TIME and np.mean(np.diff(finite) >= 0.0) < GROWING:
        return []
    whole = bool(np.all(finite == np.round(finite)))
    size, seen = _size(channel, finite)
    fitting = [
        unit
        for unit in CHANNELS[channel].quantity.units
        if unit.usual[0] <= size < unit.usual[1] and (whole or not unit.needs_scale)
    ]
    if whole:  # whole numbers are most plausibly counts
        fitting.sort(key=lambda unit: not unit.needs_scale)
    return [f"{unit.name}: {seen}; {unit.reason}" for unit in fitting]


def _size(channel: str, values: Vector) -> tuple[float, str]:
    """Give the number that measures the size of a channel's values, and a sentence on it."""
    largest, steps = float(np.max(np.abs(values))), np.diff(values)
    if channel != TIME:
        return largest, f"values reach {largest:.4g} and span {np.ptp(values):.4g}"
    size = float(np.median(steps)) if len(steps) else largest
    return size, f"the median step is {size:.4g}"


def readings_by_column(channel: str, columns: Sequence[str], table: Table) -> dict[str, list[str]]:
    """Rank the units of columns by their first batch; a column that cannot be read has no reading."""
    readings: dict[str, list[str]] = {}
    for name in columns:
        try:
            block = next(iter(table.batches([name])), None)
        except LogError:
            continue
        plausible = [] if block is None else plausible_readings(channel, block[0])
        if plausible:
            readings[name] = plausible
    return readings
