"""Choose the rows of a log that are its motion, on one clock, and list what was done to get them.

Rows that lack a value are left out, runs that follow each other in one file become stretches with a gap
between them, rows out of order are put in order, and bad rows at the ends of every run are left out.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...arrays import Samples
from ..columns.layout import Layout
from ..defects.runs import KEPT
from ..model import ArraySource, Defect, LogRows, LogSource, rows_at
from .ends import FEWEST_ROWS, BadEnd, bad_head, bad_tail, is_mostly_held
from .missing import WHAT, check_missing, missing_defects
from .order import Order, order_of
from .source import Piece, PiecedSource, WithoutRows
from .survey import Survey

END_ROWS = 4096
"""Rows of either end that are read first; more where half of them do not belong."""
SHORTEST_RUN_S = 1.0
PAUSE_S = 1.0
PAUSE_STEPS = 10.0
"""Between two runs lies so long, or so many median steps if that is longer: derivatives never cross it."""


@dataclass(frozen=True, eq=False)
class Chosen:
    """Carry the rows to study and what was done to get them."""

    source: LogSource
    done: tuple[Defect, ...] = ()
    steps: tuple[Callable[[int], int], ...] = ()
    """Each gives the number that a row had before a step of the choice."""

    def row_in_file(self, row: int) -> int:
        """Give the number that a row has in the file."""
        for before in reversed(self.steps):
            row = before(row)
        return row


def choose_rows(source: LogSource, layout: Layout, found: Survey) -> Chosen:
    """Put rows in order and leave out what does not belong.

    Parameters
    ----------
    source
        All rows of the file.
    layout
        Names the columns.
    found
        What a pass over all rows has shown.

    Raises
    ------
    LogError
        If most rows lack a value.
    """
    whole, ends = _without_missing(source, layout, found)
    ordered, starts = _in_order(_without_idle(whole, found), backwards=found.backwards)
    source = ordered.source
    edges = [*starts, source.samples]
    runs = [Piece(start, stop) for start, stop in pairwise(edges)]
    runs, of_clock = _without_broken_clock(source, runs)
    trimmed = [_trim(source, run) for run in runs]
    pieces = [piece for piece, _ in trimmed]
    done = [*ordered.done, *_end_defects([ends, of_clock, *(own for _, own in trimmed)])]
    if len(runs) > 1:
        pieces, restarts = _in_sequence(ordered, pieces)
        done.append(restarts)
    if pieces == [Piece(0, source.samples)]:
        return Chosen(source, tuple(done), ordered.steps)
    pieced = PiecedSource(source, pieces)
    return Chosen(pieced, tuple(done), (*ordered.steps, pieced.row_in_source))


def _without_missing(
    source: LogSource, layout: Layout, found: Survey
) -> tuple[Chosen, list[tuple[BadEnd, Samples]]]:
    """Leave out the rows that lack a value; give those of the ends as what they are."""
    if found.marks is None:
        return Chosen(source), []
    check_missing(found, layout)
    defects, at_ends = missing_defects(found, layout, source)
    left = WithoutRows(source, found.rows)
    ends = [(BadEnd(rows, "position", f"values are {WHAT}"), stamps) for rows, stamps in at_ends]
    return Chosen(left, defects, (left.row_in_source,)), ends


def _without_idle(chosen: Chosen, found: Survey) -> Chosen:
    """Leave out the rows that say nothing, of those that are left."""
    idle = np.setdiff1d(found.idle.numbers(), found.rows)
    if not len(idle):
        return chosen
    left = WithoutRows(chosen.source, idle - np.searchsorted(found.rows, idle))
    return Chosen(left, (*chosen.done, *found.idle.defects()), (*chosen.steps, left.row_in_source))


def _in_order(chosen: Chosen, *, backwards: bool) -> tuple[Chosen, tuple[int, ...]]:
    """Put the rows in order; give the first row of every run as well."""
    if not backwards:
        return chosen, (0,)
    source = ArraySource(chosen.source.rows(0, chosen.source.samples))
    order = order_of(source.data.time, source.data.position)
    if order.rows is None:
        return Chosen(source, chosen.done, chosen.steps), order.starts
    rows = order.rows
    done = (*chosen.done, *_order_defects(source.data, order))
    ordered = ArraySource(rows_at(source.data, rows))
    return Chosen(ordered, done, (*chosen.steps, lambda row: int(rows[row]))), order.starts


def _without_broken_clock(
    source: LogSource, runs: list[Piece]
) -> tuple[list[Piece], list[tuple[BadEnd, Samples]]]:
    """Take runs at either end that are too short to be any for rows whose clock was not set yet, or lost."""
    found = []
    for end, neighbour in ((0, 1), (-1, -2)):
        if len(runs) == 1:
            break
        stamps = source.rows(runs[end].start, runs[end].stop).time
        if stamps[-1] - stamps[0] < SHORTEST_RUN_S:
            beside = source.rows(runs[neighbour].start, runs[neighbour].start + 1).time[0]
            why = f"their stamps, from {stamps[0]:.10g} s on, are not of the clock that shows {beside:.10g} s"
            found.append((BadEnd(len(stamps), "time", why), stamps))
            runs = runs[1:] if end == 0 else runs[:-1]
    return runs, found


def _trim(source: LogSource, run: Piece) -> tuple[Piece, list[tuple[BadEnd, Samples]]]:
    """Cut bad rows off both ends; give what they are with their stamps."""
    if run.stop - run.start < FEWEST_ROWS:
        return run, []
    found = []
    head, stamps = _end(source, run, first=True)
    if head is not None:
        found.append((head, stamps))
        run = Piece(run.start + head.rows, run.stop)
    tail, stamps = _end(source, run, first=False)
    if tail is not None:
        found.append((tail, stamps))
        run = Piece(run.start, run.stop - tail.rows)
    return run, found


def _end(source: LogSource, run: Piece, *, first: bool) -> tuple[BadEnd | None, Samples]:
    """Judge one end, from as few rows as are enough."""
    size, end, rows = END_ROWS, None, None
    while rows is None or (size // 4 < run.stop - run.start and _goes_farther(rows, end, first=first)):
        if first:
            rows = source.rows(run.start, min(run.start + size, run.stop))
            end = bad_head(rows)
        else:
            rows = source.rows(max(run.stop - size, run.start), run.stop)
            end = bad_tail(rows)
        size *= 4
    if end is None:
        return None, rows.time[:0]
    return end, rows.time[: end.rows] if first else rows.time[-end.rows :]


def _goes_farther(rows: LogRows, end: BadEnd | None, *, first: bool) -> bool:
    """Tell whether so much of the rows that were read does not belong that more are needed to judge."""
    if end is not None:
        return 2 * end.rows >= len(rows.time)
    return is_mostly_held(rows if first else rows_at(rows, slice(None, None, -1)))


def _in_sequence(ordered: Chosen, pieces: list[Piece]) -> tuple[list[Piece], Defect]:
    """Lay runs one after the other on one clock, without those too short to be differentiated."""
    source = ordered.source
    ends = [source.rows(row, row + 1).time[0] for piece in pieces for row in (piece.start, piece.stop - 1)]
    spans = list(zip(ends[::2], ends[1::2], strict=True))
    kept = [number for number, (begin, end) in enumerate(spans) if end - begin >= SHORTEST_RUN_S]
    kept = kept or [0]
    step = (spans[kept[0]][1] - spans[kept[0]][0]) / max(pieces[kept[0]].stop - pieces[kept[0]].start - 1, 1)
    pause = max(PAUSE_S, PAUSE_STEPS * step)
    laid, clock = [], float(spans[kept[0]][0])
    intervals = []
    for number in kept:
        begin, end = map(float, spans[number])
        laid.append(Piece(pieces[number].start, pieces[number].stop, clock - begin))
        intervals.append((clock, clock + end - begin))
        clock += end - begin + pause
    rows = sum(piece.stop - piece.start for piece in laid[1:])
    firsts = [ordered.row_in_file(piece.start) + 1 for piece in pieces[1:6]]
    return laid, _restart_defect(firsts, (len(pieces), len(kept)), rows, intervals, pause)


def _restart_defect(
    first_rows: list[int],
    runs: tuple[int, int],
    rows: int,
    intervals: list[tuple[float, float]],
    pause: float,
) -> Defect:
    every, kept = runs
    short = every - kept
    firsts = ", ".join(map(str, first_rows)) + (", ..." if every > len(first_rows) + 1 else "")
    statement = (
        f"Time starts anew in row {firsts}: the file holds {every} runs. They are taken one after the "
        f"other, {pause:.3g} s apart on the clock, and no derivative crosses from one to the next."
    )
    if short:
        statement += f" {short} of them, shorter than {SHORTEST_RUN_S:g} s, are left out."
    longest = sorted(intervals, key=lambda span: span[0] - span[1])[:KEPT]
    return Defect("time_restarts", "time", None, rows, tuple(sorted(longest)), statement)


def _order_defects(rows: LogRows, order: Order) -> list[Defect]:
    found = []
    if order.moved:
        statement = (
            f"{order.moved} of {len(rows.time)} rows do not stand where their stamps belong, and fit the "
            "motion there: they are put in the order of time."
        )
        found.append(Defect("shuffled_rows", "time", None, order.moved, (), statement))
    if order.broken:
        what = "row has a stamp" if order.broken == 1 else "rows have stamps"
        statement = (
            f"{order.broken} {what} out of order, and would not fit the motion where they belong by them: "
            "left out as rows with a broken stamp."
        )
        found.append(Defect("broken_stamps", "time", None, order.broken, (), statement))
    return found


def _end_defects(ends: list[list[tuple[BadEnd, Samples]]]) -> list[Defect]:
    """State the bad rows of all runs, by channel."""
    found: dict[str, list[tuple[BadEnd, Samples]]] = {}
    for of_run in ends:
        for end, stamps in of_run:
            found.setdefault(end.channel, []).append((end, stamps))
    defects = []
    for channel, bad in found.items():
        rows = sum(end.rows for end, _ in bad)
        stamped = [stamps[np.isfinite(stamps)] for _, stamps in bad]
        spans = [(float(finite.min()), float(finite.max())) for finite in stamped if len(finite)]
        what = "1 row at an end is no part" if rows == 1 else f"{rows} rows at the ends are no part"
        statement = f"{what} of the motion and left out: {bad[0][0].why}."
        defects.append(Defect("bad_end", channel, None, rows, tuple(sorted(spans)[:KEPT]), statement))
    return defects
