"""Torques by another clock than the positions' are named with the offset, and nothing stands for them."""

import numpy as np
import pytest

from tests.core.conflicts.skew_arm import PLAIN, skew_arm, sound_log
from veritorque.core.log.model import JointLog, whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.study import IdentifyRequest, diagnose, identify

ARM = skew_arm()


def _log(late: float) -> JointLog:
    """Log torques that come some seconds late."""
    rows = whole_rows(sound_log(ARM))
    then = rows.time - late
    inside = (then >= rows.time[0]) & (then <= rows.time[-1])
    torque = np.stack([np.interp(then[inside], rows.time, own) for own in rows.torque.T], axis=1)
    return log_from_arrays("swing", rows.time[inside], rows.position[inside], torque)


@pytest.mark.parametrize("late", [-0.5, -0.12, 0.2, 1.0])
def test_the_offset_is_named_with_its_size(late):
    [row] = identify(IdentifyRequest(ARM, (_log(late),), PLAIN))["conflicts"]
    assert (row["conflict"], row["channel"], row["applied"]) == ("time_offset", "torque", False)
    assert ("after" if late > 0.0 else "before") in row["statement"]
    said = float(row["statement"].partition("about ")[2].partition(" s ")[0])
    assert said == pytest.approx(abs(late), abs=0.02)
    assert row["error_after_percent"] < 0.5 * row["error_before_percent"]


def test_a_log_by_one_clock_has_none():
    assert not identify(IdentifyRequest(ARM, (_log(0.0),), PLAIN))["conflicts"]


def test_no_cause_is_named_for_sure_beside_it():
    """A filter of 97 ms was named with certainty for a clock that was 100 ms late."""
    document = diagnose(IdentifyRequest(ARM, (_log(0.1),), PLAIN))
    assert [row["conflict"] for row in document["conflicts"]] == ["time_offset"]
    assert all(one["confidence"] <= 0.5 for one in document["diagnosis"]["findings"])
