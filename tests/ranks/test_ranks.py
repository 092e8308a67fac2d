"""The number of base parameters is the rank of an independent engine's regressor; `make ranks` draws 250."""

import pytest

from tests.ranks.compare import compare
from tests.ranks.drawn import STYLES


@pytest.mark.parametrize("seed", range(2 * len(STYLES)))
def test_the_base_parameters_of_a_drawn_urdf_are_as_many_as_the_rank_of_pinocchios_regressor(seed):
    found = compare(seed)
    assert found.engine.is_clear
    assert found.ours == found.engine.count
