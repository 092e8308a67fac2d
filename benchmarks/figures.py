"""Measure processor time and print figures in a table, each with what it is to reach and what others reach.

A figure is worth comparing between machines only where it is a ratio; those are marked.
"""

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass

from rich.console import Console
from rich.table import Table


@dataclass(frozen=True)
class Figure:
    """Hold one figure: its name, value with unit, target, what a peer reaches, and whether it is a ratio.

    Ratios do not depend on the machine, or hardly.
    """

    name: str
    value: str
    target: str = ""
    peer: str = ""
    ratio: bool = False


def processor_seconds(work: Callable[[], object], *, repeats: int = 5, least: float = 0.05) -> float:
    """Give the median processor time of one call, s.

    Parameters
    ----------
    repeats
        Number of measurements, of which the median is taken.
    least
        Each measurement repeats the call until this much time has passed, s.
    """
    work()
    return statistics.median(_once(work, least) for _ in range(repeats))


def _once(work: Callable[[], object], least: float) -> float:
    begin, calls = time.process_time(), 0
    while True:
        work()
        calls += 1
        spent = time.process_time() - begin
        if spent >= least:
            return spent / calls


def show(title: str, figures: list[Figure]) -> None:
    """Print the figures of one benchmark."""
    table = Table(title=title, title_justify="left")
    for heading in ("figure", "value", "target", "beside it", "ratio"):
        table.add_column(heading)
    for one in figures:
        table.add_row(one.name, one.value, one.target, one.peer, "yes" if one.ratio else "")
    Console(width=150).print(table)
