"""Hold the rows of cones to what they state, by solving for the least auxiliary variable."""

import clarabel
import numpy as np
import pytest
from scipy import sparse

from veritorque.core.estimate.cones import AUXILIARY, Cones, add_power


@pytest.mark.parametrize("mass", [1e-4, 0.03, 1.0, 7.0, 300.0])
def test_three_cones_hold_a_variable_at_the_power_of_five_thirds_of_the_mass(mass):
    cones = Cones(AUXILIARY + 1)
    cones.add(clarabel.ZeroConeT(1), np.eye(AUXILIARY + 1)[-1:], np.array([mass]))
    add_power(cones, 0, AUXILIARY)
    least = np.zeros(AUXILIARY + 1)
    least[0] = 1.0
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    found = clarabel.DefaultSolver(
        sparse.csc_matrix((len(least), len(least))),
        least,
        sparse.csc_matrix(np.vstack(cones.rows)),
        np.concatenate(cones.right),
        cones.kinds,
        settings,
    ).solve()
    assert str(found.status) == "Solved"
    assert found.x[0] == pytest.approx(mass ** (5.0 / 3.0), rel=1e-6, abs=1e-8)
