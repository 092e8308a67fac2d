"""Write motion, torque and residual of every joint at the samples used as Parquet, tile after tile.

A last pass over the logs with the parameters that were found; of it no more is held than one group of rows,
so that an hour of motion takes no more memory than a minute. Torque and residual are those that the fit saw:
behind the parallel filter. Equal studies write equal bytes.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...arrays import BaseParameters
from ...identification.result import Identification
from ...regressor.columns import ColumnPlan
from ...regressor.residuals import compare
from ...robot.model import RobotModel
from ...signals.parallel import Tile
from .layout import EXTENDED, HELD_OUT, LOG, MEASURED, PREDICTED, REVERSAL, TIME, USED, column, unit

if TYPE_CHECKING:
    import pyarrow as pa

    from ...extension.result import Extension

TILES_TOGETHER = 32
"""Tiles of one group of rows: 16384 rows at most."""
_MARKS = {USED: "whether it is used", REVERSAL: "whether it is beside a reversal, and not scored"}


@dataclass(frozen=True, eq=False)
class _Model:
    """Hold a model's columns and its base parameters."""

    plan: ColumnPlan
    parameters: BaseParameters


Rows = Mapping[str, np.ndarray]
"""Values by column."""


def write_traces(path: Path | None, found: Identification, diagnosed: "Extension | None" = None) -> None:
    """Write the file; nothing where no path is given.

    Parameters
    ----------
    diagnosed
        What a diagnosis found; the model before is then the reference where there is one, and the extended
        model's prediction stands beside it.
    """
    if path is None:
        return
    import pyarrow.parquet as pq  # takes as long to load as NumPy

    models = _models(found, diagnosed)
    schema = _schema(found.base.model.robot, extended=len(models) > 1)
    with (
        path.open("wb") as file,
        pq.ParquetWriter(file, schema, compression="zstd", use_dictionary=[LOG, HELD_OUT]) as writer,
    ):
        for log, motion in enumerate(found.motions):
            blocks = [number for source, number in found.held_out if source == log]
            parts = (_rows(tile, models, log=log, held_out=blocks) for tile in motion.tiles())
            while group := list(islice(parts, TILES_TOGETHER)):
                writer.write_table(_table(group, schema))


def _models(found: Identification, diagnosed: "Extension | None") -> tuple[_Model, ...]:
    if diagnosed is None or diagnosed.compared is None:
        before = _Model(found.observation.plan, found.estimate.base)
    else:
        before = _Model(found.observation.plan, diagnosed.compared.base)
    after = None if diagnosed is None else diagnosed.after
    return (before,) if after is None else (before, _Model(after.observation.plan, after.estimate.base))


def _table(parts: list[Rows], schema: "pa.Schema") -> "pa.Table":
    import pyarrow as pa

    rows = {name: np.concatenate([part[name] for part in parts]) for name in schema.names}
    return pa.table(rows, schema=schema)


def _rows(tile: Tile, models: tuple[_Model, ...], *, log: int, held_out: list[int]) -> Rows:
    kept = len(tile.time)
    at = slice(tile.first, None, tile.parallel.decimation)
    torque, residual = compare(models[0].plan, tile, models[0].parameters)
    series = {
        "position": tile.state.position[at][:kept],
        "velocity": tile.state.velocity[at][:kept],
        "torque_measured": tile.torque[at][:kept],
        "torque_filtered": torque,
        "torque_estimated": torque - residual,
        "residual": residual,
    }
    for extended in models[1:]:
        _, after = compare(extended.plan, tile, extended.parameters)
        series |= {"torque_estimated_after": torque - after, "residual_after": after}
    return {
        LOG: np.full(kept, log + 1, dtype=np.int32),
        TIME: tile.time,
        HELD_OUT: np.isin(tile.block, held_out),
        **{
            column(signal, joint): values.astype(np.float32)
            for signal, table in series.items()
            for joint, values in enumerate(table.T, start=1)
        },
        **{
            column(mark, joint): own
            for mark, table in ((USED, tile.usable), (REVERSAL, tile.turning))
            for joint, own in enumerate(table.T, start=1)
        },
    }


def _schema(robot: RobotModel, *, extended: bool) -> "pa.Schema":
    import pyarrow as pa

    kinds = {link.joint: link.kind for link in reversed(robot.links)}
    signals = (*MEASURED, *PREDICTED, *(EXTENDED if extended else ()))
    joints = range(1, len(robot.joints) + 1)
    fields = [
        pa.field(LOG, pa.int32(), metadata={"meaning": "number of the log, from 1"}),
        pa.field(TIME, pa.float64(), metadata={"unit": "s", "meaning": "on the log's own clock"}),
        pa.field(HELD_OUT, pa.bool_(), metadata={"meaning": "whether it is held out from every fit"}),
        *(
            pa.field(column(signal, joint), pa.float32(), metadata={"unit": unit(signal, kinds[joint])})
            for signal in signals
            for joint in joints
        ),
        *(
            pa.field(column(mark, joint), pa.bool_(), metadata={"meaning": meaning})
            for mark, meaning in _MARKS.items()
            for joint in joints
        ),
    ]
    return pa.schema(fields, metadata={"residual": "torque_filtered minus torque_estimated"})
