"""A delay that the motion's own band does not show is dropped; one that it shows stays."""

import numpy as np
import pytest

from tests.core.diagnosis.scenes import fitter_of, measured_arm
from tests.core.diagnosis.search.test_alignment import LATE, late
from veritorque.core.diagnosis.causes.time_delay import TimeDelay
from veritorque.core.diagnosis.dataset.dataset import build_dataset
from veritorque.core.diagnosis.search.motion_band import drop_what_motion_does_not_show
from veritorque.core.diagnosis.search.state import SearchState
from veritorque.core.diagnosis.search.stepwise import search_stepwise
from veritorque.core.errors import ExcitationError


def at(scene):
    """Give a scene's data set of any width."""
    dataset, model = scene.dataset, scene.operating_point.model
    log = dataset.motions[0].log
    return lambda width: build_dataset(model, (log,), held_out=dataset.held_out_blocks, blocks=5, width=width)


@pytest.fixture(scope="module")
def found():
    """What a search finds on an arm whose torques are late."""
    state = search_stepwise(fitter_of(measured_arm(late(LATE)), [TimeDelay()]))
    assert state.keys == {("time_delay", ())}
    return state


def test_what_the_motion_shows_stays(found):
    assert drop_what_motion_does_not_show(found, at(measured_arm(late(LATE)))).chosen is found.chosen


def test_what_the_motion_does_not_show_is_dropped(found):
    left = drop_what_motion_does_not_show(found, at(measured_arm()))
    assert left.keys == frozenset()
    assert [step.action for step in left.steps][-1] == "dropped"
    assert set(left.excluded) == found.keys


def test_nothing_is_dropped_where_no_row_is_left(found):
    def refuse(_width):
        raise ExcitationError("no stretch is long enough", evidence={}, remedy="record more")

    assert drop_what_motion_does_not_show(found, refuse).chosen is found.chosen


def test_a_state_at_another_operating_point_holds_the_fit_to_the_columns_there(found):
    begun = fitter_of(measured_arm(late(LATE)), [TimeDelay()])
    state = SearchState(begun.linearised_at(begun.fit(())), begun.fit(()), begun.fit(()))
    there = state.fitter.fit(found.chosen.members)
    moved = state.linearised_at(there)
    stale = moved.at(moved.fitter, there)
    assert _moves_when_fitted_again(moved) < 1e-3
    assert _moves_when_fitted_again(stale) > 0.1


def _moves_when_fitted_again(state):
    """Give how far the delay moves, in deviations."""
    again = state.fitter.fit(state.chosen.members, state.chosen)
    values, before = again.fit.values[-1], state.chosen.fit.values[-1]
    return abs(values - before) / np.sqrt(again.fit.covariance[-1, -1])
