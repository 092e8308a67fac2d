"""A scalar's deviation is told where it is settled, and as well where it is left as it is."""

import numpy as np
import pytest

from tests.core.diagnosis.made_up import candidate, made_up, nothing_found, on_joint
from tests.core.diagnosis.scenes import bench_of, measured_arm
from veritorque.core.diagnosis.search.profile_likelihood import refined, told

TRUE = 7.0
"""Waves per radian."""
RATES = tuple({"rate": rate} for rate in (6.0, 6.5, 7.0, 7.5))


@pytest.fixture(scope="module")
def bench():
    wave = made_up("wave", lambda state, scalars: [np.sin(scalars["rate"] * state.position[:, 1])], RATES)
    bench = bench_of(measured_arm(on_joint(lambda state: np.sin(TRUE * state.position[:, 1]))), (wave,))
    nothing_found(bench)
    return bench


def test_a_scalar_that_stays_where_it_is_is_known_as_well_as_one_that_is_settled_there(bench):
    none = bench.tried(())
    settled = refined(bench, none, candidate(bench.causes[0], {"rate": 7.0}))
    kept = told(bench, none, candidate(bench.causes[0], dict(settled.scalars)))
    assert kept.scalars == settled.scalars
    assert 0.0 < settled.deviations["rate"] < 0.2
    assert kept.deviations["rate"] == pytest.approx(settled.deviations["rate"], rel=0.5)


def test_on_trial_a_scalar_is_what_it_is_settled_at_and_its_deviation_is_left_open(bench):
    none = bench.tried(())
    settled, tried = (
        refined(bench, none, candidate(bench.causes[0], {"rate": 6.5}), on_trial=on_trial)
        for on_trial in (False, True)
    )
    assert tried.scalars == settled.scalars
    assert (tried.deviations, set(settled.deviations)) == ({}, {"rate"})
