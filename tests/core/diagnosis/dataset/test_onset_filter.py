"""Hold the rows of a body that comes within a log to what filtering its whole series gives."""

from functools import cache

import numpy as np
import pytest

from tests.core.diagnosis.scenes import recording, scene_of
from veritorque.core.diagnosis.dataset.dataset import Dataset
from veritorque.core.dynamics.terms.payload_change import Payload

GAP = (5.0, 7.0)
"""Seconds that were not recorded."""
ROUNDING = 1e-12


@cache
def dataset() -> Dataset:
    """Look at a log with a gap."""
    time, position, torque = recording()
    there = (time < GAP[0]) | (time > GAP[1])
    return scene_of(time[there], position[there], torque[there]).dataset


def filtered_whole(body: Payload) -> dict[int, np.ndarray]:
    """Filter a body's series sample by sample, its step included."""
    rows = [stretch.filtered(body.series(dataset().robot, stretch.state)) for stretch in dataset().stretches]
    both = np.hstack(rows)
    return {joint: both[[joint + 3 * one for one in range(10)]].T for joint in range(3)}


@pytest.mark.parametrize("begin", [-np.inf, -1.0, 0.0, 0.01, 2.5, 4.95, 6.0, 7.02, 9.333, 11.98, 12.0, 20.0])
def test_a_body_that_comes_has_the_rows_that_its_whole_series_has(begin):
    body = Payload(3, 3, begin)
    (found,) = dataset().columns([body])
    expected = filtered_whole(body)
    assert len(dataset().stretches) > 1
    assert found.keys() == expected.keys()
    for joint, rows in found.items():
        assert rows == pytest.approx(expected[joint], abs=ROUNDING * max(np.abs(expected[joint]).max(), 1.0))


def test_a_body_that_comes_later_does_nothing_before():
    (found,) = dataset().columns([Payload(3, 3, 9.0)])
    early = dataset().time < 9.0 - 0.5
    late = dataset().time > 9.0 + 0.5
    assert not any(rows[early].any() for rows in found.values())
    assert any(rows[late].any() for rows in found.values())
