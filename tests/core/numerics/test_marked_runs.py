"""Runs of marks cover the marked samples and no others, and no two of them touch."""

import numpy as np
import pytest

from veritorque.core.numerics.marked_runs import marked_runs


@pytest.mark.parametrize("samples", [0, 1, 2, 500])
@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 1.0])
def test_runs_are_the_marks_and_lie_apart(samples, share):
    marks = np.random.default_rng(samples).random(samples) < share
    runs = marked_runs(marks)
    covered = np.zeros(samples, dtype=bool)
    for first, stop in runs:
        assert first < stop
        covered[first:stop] = True
    np.testing.assert_array_equal(covered, marks)
    assert (runs[1:, 0] > runs[:-1, 1]).all()
