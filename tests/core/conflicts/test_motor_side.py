"""Positions on the motors' side of gears are named with their ratios, and the correction reads them."""

import numpy as np
import pytest

from tests.core.conflicts.skew_arm import PLAIN, skew_arm, sound_log, table_mapping, write_table
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log
from veritorque.core.study import IdentifyRequest, identify

RATIOS = np.array([101.0, 160.0, 51.0])


@pytest.fixture
def table(tmp_path):
    """Write a table of motors' angles in rad and of the joints' torques, whose names say no more."""
    rows = whole_rows(sound_log(skew_arm()))
    path = tmp_path / "log.csv"
    write_table(path, rows.time, rows.position * RATIOS, rows.torque)
    return path


@pytest.mark.parametrize("unit", ["rad", "deg"])
def test_motors_angles_are_named_with_their_ratios_and_the_correction_reads_them(table, unit):
    """In degrees they are as large as joints' angles: nothing but the torques tells."""
    robot = skew_arm()
    document = identify(IdentifyRequest(robot, (read_log(table, mapping=table_mapping(unit)),), PLAIN))
    (found,) = document["conflicts"]
    assert (found["conflict"], found["joints"], found["channel"]) == ("gear_ratio", [1, 2, 3], "position")
    assert found["confidence"] > 0.9
    assert found["applied"]
    mapping = found["correction"]["mapping"]
    again = read_log(table, mapping=mapping)
    motors = np.genfromtxt(table, delimiter=",", skip_header=1)[:, 1:4]
    ratios = np.ptp(motors, axis=0) / np.ptp(whole_rows(again).position, axis=0)
    assert ratios == pytest.approx(RATIOS, rel=0.02)
    assert not identify(IdentifyRequest(robot, (again,), PLAIN))["conflicts"]
