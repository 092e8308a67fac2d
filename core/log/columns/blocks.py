"""Guess what the columns of a table without names are: a clock, then as many columns of every quantity.

A velocity is known by being its position's derivative, and a position by being smoother than a torque, which
carries friction and noise. The guess is a suggestion that the user confirms.
"""

from itertools import permutations

import numpy as np

from ...arrays import Series
from ...errors import LogError
from ..formats.table import BY_NUMBER, Table

ALIKE = 0.9
"""Least correlation between the steps of a position, over those of the clock, and its velocity."""
QUANTITIES = (3, 2)
"""Position and torque, with velocity where one third is the rate of another: halves always fit."""
FEWEST_ROWS = 100


def unnamed_channels(table: Table) -> dict[str, list[str]]:
    """Give the columns of every channel, the clock under `time`; empty where the columns have names.

    Examples
    --------
    >>> from veritorque.core.log.formats.table import MemoryTable
    >>> time = np.arange(300) / 100.0
    >>> torque = np.sin(3.0 * time) + 0.1 * np.random.default_rng(0).standard_normal(300)
    >>> unnamed_channels(MemoryTable({"column_1": time, "column_2": np.sin(time), "column_3": torque}))
    {'time': ['column_1'], 'position': ['column_2'], 'torque': ['column_3']}
    """
    names = table.names
    if not all(name.startswith(BY_NUMBER) for name in names):
        return {}
    try:
        block = next(iter(table.batches(names)), np.empty((len(names), 0)))
    except LogError:
        return {}
    block = block[:, np.isfinite(block).all(axis=0)]
    if block.shape[1] < FEWEST_ROWS or not np.all(np.diff(block[0]) > 0.0):
        return {}
    return next((found for count in QUANTITIES if (found := _channels_of(names, block, count))), {})


def _channels_of(names: tuple[str, ...], block: Series, count: int) -> dict[str, list[str]]:
    """Tell so many quantities of all joints; empty where the columns are not so many."""
    joints, rest = divmod(len(names) - 1, count)
    if rest or not joints:
        return {}
    spans = [slice(1 + place * joints, 1 + (place + 1) * joints) for place in range(count)]
    quantities = [block[span] for span in spans]
    rates = _rates(block[0], quantities)
    if len(rates) != count - 2:
        return {}
    places = _places(quantities, rates)
    return {"time": [names[0]]} | {channel: list(names[spans[place]]) for channel, place in places.items()}


def _places(quantities: list[Series], rates: list[tuple[int, int]]) -> dict[str, int]:
    """Tell which quantity is which: torque is rougher than a position, of which another is the rate."""
    others = sorted({*range(len(quantities))} - {rate for _, rate in rates})
    position = rates[0][0] if rates else min(others, key=lambda place: _roughness(quantities[place]))
    torque = next(place for place in others if place != position)
    return {"position": position, "torque": torque} | ({"velocity": rates[0][1]} if rates else {})


def _rates(time: np.ndarray, quantities: list[Series]) -> list[tuple[int, int]]:
    """Find quantities and their derivatives, by their places."""
    middle = [0.5 * (values[:, 1:] + values[:, :-1]) for values in quantities]
    slopes = [np.diff(values, axis=1) / np.diff(time) for values in quantities]
    return [
        (position, rate)
        for position, rate in permutations(range(len(quantities)), 2)
        if _alike(slopes[position], middle[rate])
    ]


def _alike(first: Series, second: Series) -> bool:
    products = np.sum(first * second)
    return bool(products > ALIKE * np.sqrt(np.sum(first**2) * np.sum(second**2)) > 0.0)


def _roughness(values: Series) -> float:
    """Give the mean square of the second differences over the variance."""
    bends = np.sum(np.diff(values, n=2, axis=1) ** 2)
    return float(bends / max(float(np.sum((values - values.mean(axis=1, keepdims=True)) ** 2)), 1e-300))
