"""What is wrong with one of several logs is said of that log, and its correction reads that one anew."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from tests.core.conflicts.skew_arm import PLAIN, skew_arm, sound_log
from veritorque.core.log.model import JointLog, LogRows, whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.study import IdentifyRequest, identify

ARM = skew_arm()


def _changed(log: JointLog, change: Callable[[LogRows], None]) -> JointLog:
    """Change the arrays of a log, as its recorder might have."""
    rows = whole_rows(log)
    rows = replace(rows, position=rows.position.copy(), torque=rows.torque.copy())
    change(rows)
    return log_from_arrays(log.name, rows.time, rows.position, rows.torque)


def _reverse(rows: LogRows) -> None:
    rows.torque[:, 1] *= -1.0


def _enlarge(rows: LogRows) -> None:
    rows.torque[:, 1] *= 1000.0


def _turn(rows: LogRows) -> None:
    rows.position[:, 1] += 0.96


def _replace(rows: LogRows) -> None:
    rows.torque[:, 1] = np.gradient(rows.position[:, 1], rows.time)


def _rectify(rows: LogRows) -> None:
    rows.torque[:, 1] = np.abs(rows.torque[:, 1])


SPOILT = [
    ("torque_sign", _reverse),
    ("unit", _enlarge),
    ("zero_offset", _turn),
    ("other_signal", _replace),
    ("other_signal", _rectify),
]


@pytest.mark.parametrize(("conflict", "change"), SPOILT)
def test_it_is_said_of_the_log_that_is_spoilt(conflict, change):
    """Reversed in all logs, the torque of a joint fitted one log and failed on the sound ones."""
    logs = (sound_log(ARM, 5), _changed(sound_log(ARM, 6), change))
    document = identify(IdentifyRequest(ARM, logs, PLAIN))
    [row] = document["conflicts"]
    assert (row["conflict"], row["joints"], row["applied"]) == (conflict, [2], False)
    assert "in log 6 alone" in row["statement"]
    sound, corrected = row["correction"]["mappings"]
    assert "scale" not in sound["torque"]
    assert "offset" not in sound["position"]
    assert corrected != sound


def test_nothing_is_said_of_sound_logs():
    assert not identify(IdentifyRequest(ARM, (sound_log(ARM, 5), sound_log(ARM, 6)), PLAIN))["conflicts"]


def test_a_log_that_is_held_out_as_a_whole_decides_nothing():
    logs = (sound_log(ARM, 5), _changed(sound_log(ARM, 6), _reverse), sound_log(ARM, 7))
    document = identify(IdentifyRequest(ARM, logs, PLAIN | {"validation": {"logs": [2]}}))
    assert not document["conflicts"]
