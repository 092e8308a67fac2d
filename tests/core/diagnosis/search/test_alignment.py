"""Where all torques are late, the delay takes the place of a filter that was found in its stead."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from tests.core.diagnosis.causes.test_late_torque import ideal_torque
from tests.core.diagnosis.scenes import fitter_of, measured_arm
from veritorque.core.diagnosis.causes.time_delay import TimeDelay
from veritorque.core.diagnosis.causes.torque_filter_lag import TorqueFilterLag
from veritorque.core.diagnosis.search.alignment import restart_from_alignment
from veritorque.core.diagnosis.search.stepwise import search_stepwise

LATE = 0.015
CAUSES = (TorqueFilterLag(), TimeDelay())


def late(seconds):
    def effect(state):
        torque = ideal_torque(state)
        then = np.clip(state.time - seconds, state.time[0], state.time[-1])
        return CubicSpline(state.time, torque)(then) - torque

    return effect


@pytest.fixture(scope="module")
def later():
    """The torque of the late arm, taken so many seconds later."""
    return lambda seconds: measured_arm(late(LATE - seconds)).dataset.torque


def test_a_delay_takes_the_place_of_a_filter(later):
    arm = measured_arm(late(LATE))
    found = search_stepwise(fitter_of(arm, [TorqueFilterLag()]))
    assert [member.cause.id for member in found.chosen.members] == ["torque_filter_lag"]
    fitter = fitter_of(arm, CAUSES)
    begun = found.at(fitter.linearised_at(found.chosen), fitter.fit(found.chosen.members))
    (member,) = (better := restart_from_alignment(begun, later)).chosen.members
    assert member.cause.id == "time_delay"
    assert better.chosen.fit.values[better.chosen.columns_of(0)][0] == pytest.approx(LATE, rel=0.02)


def test_where_nothing_is_found_nothing_is_shifted():
    found = search_stepwise(fitter_of(measured_arm(), CAUSES))

    def refuse(seconds):
        raise AssertionError(seconds)

    assert restart_from_alignment(found, refuse) is found
