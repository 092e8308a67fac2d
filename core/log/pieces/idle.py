"""Find rows inside a log that say nothing: written twice, stamp and all, or zeros of a lost packet.

A recorder writes a row again where it flushes twice, and zeros where a packet is lost. Neither is a defect of
the clock or of the motion, so that both are left out before these are judged.
"""

import numpy as np

from ...arrays import Indices, SampleMask
from ..defects.stretch import count_text
from ..model import STANDING_ROWS, Defect, LogRows, LogSource
from .ends import JUMP_FACTOR, USUAL_SHARE
from .survey import BLOCK_ROWS


def idle_rows(source: LogSource) -> tuple[Indices, tuple[Defect, ...]]:
    """Give the numbers of the rows that say nothing, and what they are."""
    found: dict[str, list[Indices]] = {"doubled_rows": [], "blank_rows": []}
    for start in range(0, source.samples, BLOCK_ROWS):
        first = max(start - 1, 0)
        rows = source.rows(first, min(start + BLOCK_ROWS, source.samples))
        for kind, marks in (("doubled_rows", _doubled(rows)), ("blank_rows", _blank(rows))):
            found[kind].append(first + np.flatnonzero(marks))
    numbers = {kind: np.unique(np.concatenate(parts)) for kind, parts in found.items()}
    statements = {
        "doubled_rows": "repeat the row before, stamp and all, and are left out",
        "blank_rows": "are zero in all positions and efforts while the robot is elsewhere, and are left out",
    }
    defects = [
        Defect(kind, "file", None, len(rows), (), f"{count_text(len(rows), 'row')} {statements[kind]}.")
        for kind, rows in numbers.items()
        if len(rows)
    ]
    return np.union1d(*numbers.values()), tuple(defects)


def _doubled(rows: LogRows) -> SampleMask:
    marks = np.zeros(len(rows.time), dtype=bool)
    marks[1:] = rows.time[1:] == rows.time[:-1]
    for values in rows.channels().values() if marks.any() else ():
        marks[1:] &= np.all((values[1:] == values[:-1]) | np.isnan(values[1:]), axis=1)
    return marks


def _blank(rows: LogRows) -> SampleMask:
    """Mark short runs of zeros between rows at which a joint is too far from zero to have come from there."""
    efforts = [values for values in (rows.torque, rows.current) if values is not None]
    zero = np.all(np.hstack([rows.position, *efforts]) == 0.0, axis=1)
    marks = np.zeros(len(zero), dtype=bool)
    if not zero.any() or zero.all():
        return marks
    steps = np.abs(np.diff(rows.position[~zero], axis=0))
    usual = np.quantile(steps, USUAL_SHARE, axis=0) if len(steps) else np.zeros(rows.position.shape[1])
    edges = np.flatnonzero(np.diff(zero, prepend=False, append=False))
    for start, stop in zip(edges[::2], edges[1::2], strict=True):
        if start == 0 or stop == len(zero) or stop - start > STANDING_ROWS:
            continue  # an end's, or a standstill
        if np.all(np.diff(rows.time[start - 1 : stop + 1]) >= 0.0):  # else the end of a run
            nearest = np.minimum(np.abs(rows.position[start - 1]), np.abs(rows.position[stop]))
            marks[start:stop] = np.any(nearest > JUMP_FACTOR * usual * (stop - start))
    return marks
