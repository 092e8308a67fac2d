"""Efforts of a little later: exact on a smooth signal, whatever is read at once, and no gap is crossed."""

from dataclasses import replace

import numpy as np
import pytest

from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.log.shifted import with_later_effort

RATE_HZ = 200.0


def log_of(time):
    torque = np.column_stack([np.sin(5.0 * time), np.cos(3.0 * time)])
    return log_from_arrays("wave", time, torque.copy(), torque)


@pytest.mark.parametrize("seconds", [-0.0131, 0.004, 0.03])
def test_a_wave_is_that_of_later(seconds):
    time = np.arange(2000) / RATE_HZ
    log = log_of(time)
    rows, inner = whole_rows(with_later_effort(log, seconds)), slice(20, -20)
    assert np.abs(rows.torque[inner, 0] - np.sin(5.0 * (time[inner] + seconds))).max() < 1e-5
    assert np.array_equal(rows.position, whole_rows(log).position)


def test_what_is_read_at_once_does_not_matter():
    shifted = with_later_effort(log_of(np.arange(2000) / RATE_HZ), 0.0077)
    whole = whole_rows(shifted).torque
    parts = [shifted.source.rows(start, min(start + 331, 2000)).torque for start in range(0, 2000, 331)]
    assert np.abs(np.vstack(parts) - whole).max() < 1e-9


def test_a_gap_is_not_crossed():
    time = np.arange(2000) / RATE_HZ
    time[1000:] += 5.0
    log = log_of(time)
    log = replace(log, segments=((0, 1000), (1000, 2000)))
    torque = whole_rows(with_later_effort(log, 0.02)).torque
    assert np.array_equal(torque[996:1000, 0], np.full(4, whole_rows(log).torque[999, 0]))
