"""A position that is counted from the horizontal is named, and the correction reads the joint's own."""

import numpy as np
import pytest

from tests.core.conflicts.skew_arm import PLAIN, skew_arm, sound_log, table_mapping, write_table
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log
from veritorque.core.study import IdentifyRequest, identify


@pytest.mark.parametrize(("factor", "said"), [(1.0, "plus"), (-1.0, "less")])
def test_the_angle_of_a_link_is_named_and_the_correction_reads_that_of_its_joint(tmp_path, factor, said):
    robot, path = skew_arm(), tmp_path / "log.csv"
    rows = whole_rows(sound_log(robot))
    shown = rows.position.copy()
    shown[:, 2] += factor * shown[:, 1]
    write_table(path, rows.time, shown, rows.torque)
    log = read_log(path, mapping=table_mapping())
    (found,) = identify(IdentifyRequest(robot, (log,), PLAIN))["conflicts"]
    assert (found["conflict"], found["joints"], found["channel"]) == ("position_linkage", [3], "position")
    assert f"is its angle {said} that of joint 2" in found["statement"]
    assert found["confidence"] > 0.9
    assert found["applied"]
    mapping = found["correction"]["mapping"]
    assert mapping["position"]["linkage"] == [{"joint": 3, "adds": 2, "factor": -factor}]
    again = read_log(path, mapping=mapping)
    np.testing.assert_allclose(whole_rows(again).position, rows.position, atol=1e-6)
    assert not identify(IdentifyRequest(robot, (again,), PLAIN))["conflicts"]


def test_a_linkage_that_was_declared_in_vain_is_taken_back(tmp_path):
    robot, path = skew_arm(), tmp_path / "log.csv"
    rows = whole_rows(sound_log(robot))
    write_table(path, rows.time, rows.position, rows.torque)
    mapping = table_mapping()
    mapping["position"]["linkage"] = [{"joint": 3, "adds": 2}]
    log = read_log(path, mapping=mapping)
    (found,) = identify(IdentifyRequest(robot, (log,), PLAIN))["conflicts"]
    assert found["conflict"] == "position_linkage"
    assert "linkage" not in found["correction"]["mapping"]["position"]
