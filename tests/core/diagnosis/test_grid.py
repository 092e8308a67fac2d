"""Where a scalar is looked for between the points that it was scanned at."""

import numpy as np
import pytest

from core.diagnosis.grid import FINEST, closely

GRID = [1.0, 2.0, 3.0, 4.0]


@pytest.mark.parametrize("here", [1.0, 2.0, 2.43, 4.0])
def test_a_close_look_goes_from_one_point_of_the_grid_before_to_one_after(here):
    points = closely(GRID, here)
    assert min(points) == pytest.approx(here - 1.0, abs=1.5 / FINEST)
    assert max(points) == pytest.approx(here + 1.0, abs=1.5 / FINEST)
    assert np.diff(points) == pytest.approx(1.0 / FINEST)


def test_close_looks_from_two_places_share_their_points():
    assert set(closely(GRID, 2.0)) & set(closely(GRID, 2.5)) == {
        one for one in closely(GRID, 2.0) if one > 1.5
    }
