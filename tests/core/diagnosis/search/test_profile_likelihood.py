"""A scalar's deviation is told where it is settled, and as well where it is left as it is."""

import numpy as np
import pytest

from tests.core.diagnosis.made_up import candidate, made_up, nothing_found, on_joint
from tests.core.diagnosis.scenes import fitter_of, measured_arm
from veritorque.core.diagnosis.search.profile_likelihood import refine_scalars, with_deviations

TRUE = 7.0
"""Waves per radian."""
RATES = tuple({"rate": rate} for rate in (6.0, 6.5, 7.0, 7.5))


@pytest.fixture(scope="module")
def fitter():
    wave = made_up("wave", lambda state, scalars: [np.sin(scalars["rate"] * state.position[:, 1])], RATES)
    fitter = fitter_of(measured_arm(on_joint(lambda state: np.sin(TRUE * state.position[:, 1]))), (wave,))
    nothing_found(fitter)
    return fitter


def test_a_scalar_that_stays_where_it_is_is_known_as_well_as_one_that_is_settled_there(fitter):
    none = fitter.fit(())
    refine_jointly = refine_scalars(fitter, none, candidate(fitter.causes[0], {"rate": 7.0}))
    kept = with_deviations(fitter, none, candidate(fitter.causes[0], dict(refine_jointly.scalars)))
    assert kept.scalars == refine_jointly.scalars
    assert 0.0 < refine_jointly.deviations["rate"] < 0.2
    assert kept.deviations["rate"] == pytest.approx(refine_jointly.deviations["rate"], rel=0.5)


def test_on_trial_a_scalar_is_what_it_is_settled_at_and_its_deviation_is_left_open(fitter):
    none = fitter.fit(())
    refine_jointly, tried = (
        refine_scalars(fitter, none, candidate(fitter.causes[0], {"rate": 6.5}), on_trial=on_trial)
        for on_trial in (False, True)
    )
    assert tried.scalars == refine_jointly.scalars
    assert (tried.deviations, set(refine_jointly.deviations)) == ({}, {"rate"})


def test_a_scalar_beside_a_grid_point_is_refined_as_far_as_one_on_it(fitter):
    """From so little below a point it once came no further than the distance to it."""
    none = fitter.fit(())
    beside = refine_scalars(fitter, none, candidate(fitter.causes[0], {"rate": 6.499}), on_trial=True)
    assert beside.scalars["rate"] == pytest.approx(TRUE, abs=0.1)
