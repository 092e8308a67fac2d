"""Compute a joint's residual over position, velocity and frequency, from a file of traces.

Over a coordinate, rows that count are sorted into bins of nearly equally many: a mean that leaves zero by
more than its neighbours says that the model lacks something which depends on that coordinate, and the band
between quantiles shows the spread of single rows. Over frequency the density of unbroken runs is averaged.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

from ...arrays import Mask, Samples, Vector
from ...errors import ExcitationError
from ...numerics.marked_runs import marked_runs
from ...numerics.power_density import power_density
from .layout import TIME, USED, column
from .reading import LogOfTraces, stretches

COORDINATES = ("position", "velocity")
RESIDUALS = ("residual", "residual_after")
BINS = 40
FEWEST_IN_BIN = 5
BAND = (0.05, 0.95)


@dataclass(frozen=True, eq=False)
class Curve:
    """Hold one residual over a coordinate: mean, and the quantiles of `BAND`, per bin."""

    signal: str
    mean: Vector
    low: Vector
    high: Vector


@dataclass(frozen=True, eq=False)
class OverCoordinate:
    """Hold residuals over one coordinate, with the medians of the bins."""

    coordinate: str
    unit: str
    centre: Vector
    curves: tuple[Curve, ...]


@dataclass(frozen=True, eq=False)
class Density:
    """Hold the power density of one residual, its unit squared per Hz; empty if no run is long enough."""

    signal: str
    frequency_hz: Vector
    density: Vector


@dataclass(frozen=True, eq=False)
class Views:
    """Hold the residual of one joint over coordinates and frequency."""

    unit: str
    samples: int
    """Unit of the residual, and the number of rows that count."""
    over: tuple[OverCoordinate, ...]
    densities: tuple[Density, ...]


def read_views(path: Path, *, log: int, joint: int) -> Views:
    """Read the residuals of a joint of a log, both counted from 1.

    Raises
    ------
    OptionError
        If there is no such log or joint.
    ExcitationError
        If too few rows count.
    """
    with pq.ParquetFile(path) as file:
        rows = LogOfTraces(file, log)
        signals = [signal for signal in rows.known(joint) if signal in RESIDUALS]
        used = rows.column(column(USED, joint))
        residual = {signal: rows.column(column(signal, joint)).astype(float) for signal in signals}
        if used.sum() < 2 * FEWEST_IN_BIN:
            raise ExcitationError(
                f"too few instants count for joint {joint}",
                evidence={"instants": int(used.sum()), "at_least": 2 * FEWEST_IN_BIN},
                remedy="choose another joint, or record a motion of this one",
            )
        over = tuple(
            _over(
                name, rows.unit(column(name, joint)), rows.column(column(name, joint))[used], residual, used
            )
            for name in COORDINATES
        )
        runs = list(_runs(rows.column(TIME), used))
        rate = 1.0 / float(np.median(np.diff(rows.column(TIME))))
        densities = tuple(
            Density(name, *power_density([values[run] for run in runs], rate))
            for name, values in residual.items()
        )
        return Views(rows.unit(column("residual", joint)), int(used.sum()), over, densities)


def _over(name: str, unit: str, values: Samples, residual: dict[str, Samples], used: Mask) -> OverCoordinate:
    parts = np.array_split(np.argsort(values, kind="stable"), min(BINS, len(values) // FEWEST_IN_BIN))
    curves = []
    for signal, left in residual.items():
        binned = [left[used][part] for part in parts]
        low, high = np.array([np.quantile(values, BAND) for values in binned]).T
        curves.append(Curve(signal, np.array([values.mean() for values in binned]), low, high))
    centre = np.array([np.median(values[part]) for part in parts], dtype=float)
    return OverCoordinate(name, unit, centre, tuple(curves))


def _runs(time: Samples, used: Mask) -> Iterator[slice]:
    """Give the unbroken runs of rows used."""
    for start, stop in stretches(time):
        for begin, end in (start + marked_runs(used[start:stop])).tolist():
            yield slice(begin, end)
