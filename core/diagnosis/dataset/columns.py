"""Filter the columns of terms over the stretches of a data set, many at once."""

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache

import numpy as np

from ...arrays import KeptSeries, Series
from ...dynamics.term import Entry, Term
from ...dynamics.terms.payload_change import Payload
from ...dynamics.terms.unnamed_pattern import Trace
from ...robot.model import RobotModel
from .stretch import Stretch

BATCH = 64
"""Series that are filtered at once: as many as stay near the processor."""


def term_columns(
    terms: Sequence[Term], robot: RobotModel, stretches: Sequence[Stretch], rows: int
) -> list[dict[int, np.ndarray]]:
    """Give, per term and joint (from 0), the filtered rows per unit parameter.

    Patterns that do not depend on the joint that they act on are filtered once for all joints.
    """
    alike: dict[object, list[int]] = {}
    for index, term in enumerate(terms):
        alike.setdefault(term.source if isinstance(term, Trace) else index, []).append(index)
    found = _filtered([terms[indices[0]] for indices in alike.values()], robot, stretches, rows)
    out: list[dict[int, np.ndarray]] = [{} for _ in terms]
    for (first, *others), columns in zip(alike.values(), found, strict=True):
        out[first] = columns
        for index in others:
            joints = dict(terms[index].entries(robot))
            out[index] = dict(zip(joints, columns.values(), strict=True))
    return out


def _filtered(
    terms: Sequence[Term], robot: RobotModel, stretches: Sequence[Stretch], rows: int
) -> list[dict[int, np.ndarray]]:
    entries = [term.entries(robot) for term in terms]
    out = [_no_columns(pairs, rows) for pairs in entries]
    for stretch in stretches:
        for index, filtered in _filter(terms, robot, stretch):
            for (joint, parameter), row in zip(entries[index], filtered, strict=True):
                out[index][joint][stretch.rows, parameter] += row
    return out


def _no_columns(entries: Sequence[Entry], rows: int) -> dict[int, np.ndarray]:
    """Give a table per joint, wide enough for the last parameter that acts."""
    width = max((1 + parameter for _, parameter in entries), default=0)
    return {joint: np.zeros((rows, width)) for joint in dict(entries)}


def _filter(terms: Sequence[Term], robot: RobotModel, stretch: Stretch) -> Iterator[tuple[int, KeptSeries]]:
    """Filter the series of some terms over a stretch; give each term's with its number."""
    batch: dict[int, Series] = {}
    waiting = 0
    for index, term in enumerate(terms):
        if isinstance(term, Payload):
            yield index, onset_rows(term, robot, stretch)
            continue
        batch[index] = term.series(robot, stretch.state)
        waiting += len(batch[index])
        if waiting >= BATCH:
            yield from _filter_batch(batch, stretch)
            batch, waiting = {}, 0
    if batch:
        yield from _filter_batch(batch, stretch)


def _filter_batch(batch: Mapping[int, Series], stretch: Stretch) -> Iterator[tuple[int, KeptSeries]]:
    ends = np.cumsum([len(series) for series in batch.values()])[:-1]
    filtered = stretch.filtered(np.vstack(list(batch.values())))
    yield from zip(batch, np.split(filtered, ends), strict=True)


def onset_rows(body: Payload, robot: RobotModel, stretch: Stretch) -> KeptSeries:
    """Give the filtered series of a body, from those of one that is always there.

    Its onset is searched finely and its columns are many; away from the onset they are the other's, or zero.
    """
    time = stretch.state.time
    begin = 0 if time is None else int(np.searchsorted(time, body.begin))
    return stretch.begun(*_throughout(robot, body.link, stretch), begin)


@lru_cache(maxsize=8)
def _throughout(robot: RobotModel, link: int, stretch: Stretch) -> tuple[Series, KeptSeries]:
    """Give the series of a body that was there all along, and what filtering them gives."""
    series = Payload(0, link, -np.inf).series(robot, stretch.state)
    return series, stretch.filtered(series)
