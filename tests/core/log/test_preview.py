from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from veritorque.core.log import preview as module
from veritorque.core.log.preview import FEWEST_POINTS, preview, thin
from veritorque.core.log.reader import log_from_arrays


def walk(rows, traces=3, seed=1):
    steps = np.random.default_rng(seed).standard_normal((rows, traces))
    return np.arange(rows) / 250.0, np.cumsum(steps, axis=0)


def thin_arrays(time, values, segments=None, *, points):
    """Thin traces that are in memory."""
    rows = segments or ((0, len(time)),)
    return thin(lambda start, stop: (time[start:stop], values[start:stop]), rows, points=points)


@st.composite
def cut_logs(draw):
    """Give the number of rows, borders of gaps between them, and the points asked for."""
    rows = draw(st.integers(1, 3000))
    borders = sorted(draw(st.sets(st.integers(1, max(1, rows - 1)), max_size=40)) - {rows})
    edges = [0, *borders, rows]
    return rows, tuple(pairwise(edges)), draw(st.integers(FEWEST_POINTS, 600))


@given(cut_logs())
def test_no_more_points_than_asked_for_and_every_extreme_is_kept_in_order_of_time(case):
    rows, segments, points = case
    time, values = walk(rows)
    seen = thin_arrays(time, values, segments, points=points)
    assert len(seen.time) == len(seen.values) <= points
    assert np.all(np.diff(seen.time) > 0)
    assert (seen.time[0], seen.time[-1]) == (time[0], time[-1])
    assert np.array_equal(np.nanmax(seen.values, axis=0), values.max(axis=0))
    assert np.array_equal(np.nanmin(seen.values, axis=0), values.min(axis=0))


@given(cut_logs())
def test_a_gap_is_left_open_and_nothing_else_is(case):
    rows, segments, points = case
    time, values = walk(rows)
    open_at = np.isnan(thin_arrays(time, values, segments, points=points).values)
    assert np.array_equal(open_at.all(axis=1), open_at.any(axis=1))
    assert open_at.all(axis=1).sum() == min(len(segments), max(1, points // 8)) - 1


def test_few_rows_stay_as_they_are():
    time, values = walk(50)
    seen = thin_arrays(time, values, points=50)
    assert seen.rows_per_stretch == 1
    assert np.array_equal(seen.time, time)
    assert np.array_equal(seen.values, values)


def test_every_stretch_shows_its_own_extremes():
    time, values = walk(1000)
    seen = thin_arrays(time, values, points=100)
    assert seen.rows_per_stretch == 20
    for number in range(50):
        rows, pair = values[20 * number : 20 * number + 20], seen.values[2 * number : 2 * number + 2]
        assert np.array_equal(np.sort(pair, axis=0), np.stack([rows.min(axis=0), rows.max(axis=0)]))


def test_a_fast_sine_keeps_its_height_where_every_nth_row_would_lose_it():
    time = np.arange(10_000) / 1000.0
    sine = np.sin(2 * np.pi * 50.0 * time)[:, None]
    assert np.ptp(sine[::100]) < 1e-9  # what skipping rows would show: 10 Hz of a 50 Hz wave, a flat line
    heights = thin_arrays(time, sine, points=1000).values[:, 0]
    assert heights.max() > 0.99
    assert heights.min() < -0.99


def test_what_is_not_known_is_passed_over_and_drawn_as_a_gap_where_nothing_else_is_there():
    time, values = walk(1000, traces=2)
    values[100:140, 0] = np.nan
    values[205, 1] = np.nan
    seen = thin_arrays(time, values, points=100).values
    assert np.isnan(seen[10:14, 0]).all()
    assert np.isnan(seen).sum() == 4


def test_the_rows_are_read_once_and_piece_by_piece(monkeypatch):
    monkeypatch.setattr(module, "CHUNK_ROWS", 1000)
    time, values = walk(20_000)
    read = []

    def rows(start, stop):
        read.append((start, stop))
        return time[start:stop], values[start:stop]

    piecewise = thin(rows, ((0, 12_000), (12_000, 20_000)), points=400)
    assert max(stop - start for start, stop in read) <= 1000
    assert read[0][0] == 0
    assert read[-1][1] == 20_000
    assert all(before[1] == after[0] for before, after in pairwise(read))
    whole = thin_arrays(time, values, ((0, 12_000), (12_000, 20_000)), points=400)
    assert np.array_equal(piecewise.values, whole.values, equal_nan=True)


def test_a_log_is_shown_channel_by_channel_with_its_gaps():
    time = np.arange(2000) / 100.0
    time[1000:] += 5.0
    position = np.sin(np.outer(time, [1.0, 2.0]))
    log = log_from_arrays("swing", time, position, 3.0 * position)
    seen = preview(log, ("torque", "position"), points=200)
    assert seen.values.shape[1] == 4
    assert np.nanmax(seen.values, axis=0) == pytest.approx([3.0, 3.0, 1.0, 1.0], abs=1e-3)
    (gap,) = np.flatnonzero(np.isnan(seen.values[:, 0]))
    assert time[999] < seen.time[gap] < time[1000]
