import numpy as np
import pytest

from tests.core.log.writers import swing, write_csv, write_parquet
from veritorque.core.errors import LogError
from veritorque.core.log.columns.profiles import PROFILES, fill_in
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

COLUMNS = swing()
COLUMNS |= {f"qd_{joint}": np.gradient(COLUMNS[f"q_{joint}"], COLUMNS["time"]) for joint in (1, 2, 3)}


def renamed(time, scale=1.0, first=0, **patterns):
    """Name the columns as a recorder does, in reverse so that their order in the file says nothing."""
    table = {time: COLUMNS["time"] * scale}
    for prefix, pattern in reversed(patterns.items()):
        for joint in (3, 1, 2):
            table[pattern.format(joint - 1 + first)] = COLUMNS[f"{prefix}_{joint}"]
    return table


RECORDERS = {
    "generic": (COLUMNS, {}),
    "ur-rtde": (renamed("timestamp", q="actual_q_{}", qd="actual_qd_{}", tau="actual_current_{}"), {}),
    "franka": (renamed("time", 1e3, q="state.q[{}]", qd="state.dq[{}]", tau="state.tau_J[{}]"), {}),
    "ros-jointstate": (
        renamed("time", first=1, q="position.joint{}", qd="velocity.joint{}", tau="effort.joint{}"),
        {},
    ),
    "lerobot": (
        renamed("timestamp", first=1, q="observation.state_{}", tau="observation.effort_{}"),
        {"position": {"unit": "rad"}, "torque": {"unit": "N m"}},
    ),
    "rostopic": (
        renamed("%time", 1e9, q="field.position{}", qd="field.velocity{}", tau="field.effort{}"),
        {},
    ),
    "kuka-fri": (renamed("time", first=1, q="mp{}", tau="mt{}"), {}),
    "kinova-kortex": (
        renamed("timestamp", q="actuators[{}].position", tau="actuators[{}].torque"),
        {"time": {"column": "timestamp", "unit": "s"}, "position": {"unit": "rad"}},
    ),
    "abb-egm": (
        renamed("feedback.time", 1e6, q="feedback.joints[{}]")
        | {f"tau_{j}": COLUMNS[f"tau_{j}"] for j in (1, 2, 3)},
        {"position": {"unit": "rad"}},
    ),
    "abb-test-signal-viewer": (
        renamed("Time", first=1, q="resolver_angle_{}", tau="torque_ref_{}"),
        {"time": {"column": "Time", "unit": "s"}, "position": {"unit": "rad"}, "torque": {"unit": "N m"}},
    ),
}


def test_every_profile_is_tried_here():
    assert set(RECORDERS) == set(PROFILES)


@pytest.mark.parametrize("profile", RECORDERS)
def test_a_profile_finds_the_columns_of_its_recorder_in_the_order_of_the_joints(profile, tmp_path):
    table, declared = RECORDERS[profile]
    log = read_log(write_csv(tmp_path / "log.csv", table), mapping={"profile": profile} | declared)
    rows = whole_rows(log)
    effort = rows.current if profile == "ur-rtde" else rows.torque
    np.testing.assert_allclose(rows.time, COLUMNS["time"], rtol=1e-12)
    np.testing.assert_array_equal(rows.position, np.column_stack([COLUMNS[f"q_{j}"] for j in (1, 2, 3)]))
    np.testing.assert_array_equal(effort, np.column_stack([COLUMNS[f"tau_{j}"] for j in (1, 2, 3)]))


def test_the_names_of_older_releases_of_libfranka_are_known(tmp_path):
    table = renamed("duration", 1e3, q="q[{}]", qd="dq[{}]", tau="tau_J[{}]")
    table |= {
        f"q_d[{joint}]": COLUMNS["q_1"] + 1.0 for joint in range(3)
    }  # what was asked for is not measured
    log = read_log(write_csv(tmp_path / "log.csv", table), mapping={"profile": "franka"})
    np.testing.assert_array_equal(whole_rows(log).position[:, 1], COLUMNS["q_2"])


@pytest.mark.parametrize("profile", ["lerobot", "abb-test-signal-viewer"])
def test_a_unit_that_the_recorder_leaves_open_has_to_be_declared(profile, tmp_path):
    table, _ = RECORDERS[profile]
    with pytest.raises(LogError, match="is not declared"):
        read_log(write_csv(tmp_path / "log.csv", table), mapping={"profile": profile})


def test_what_the_mapping_says_itself_stands_above_the_profile(tmp_path):
    table, _ = RECORDERS["ur-rtde"]
    mapping = {"profile": "ur-rtde", "velocity": None, "current": {"scale": 2.0}, "joints": ["2", "0"]}
    log = read_log(write_csv(tmp_path / "log.csv", table), mapping=mapping)
    rows = whole_rows(log)
    assert log.channels == ("position", "current")
    np.testing.assert_array_equal(rows.position[:, 0], COLUMNS["q_3"])
    np.testing.assert_array_equal(rows.current[:, 1], 2.0 * COLUMNS["tau_1"])


def test_joints_whose_names_do_not_say_their_order_have_to_be_listed(tmp_path):
    names = {1: "shoulder_pan", 2: "shoulder_lift", 3: "elbow"}
    table = {"time": COLUMNS["time"]}
    for prefix, field in (("q", "position"), ("tau", "effort")):
        table |= {f"{field}.{names[joint]}": COLUMNS[f"{prefix}_{joint}"] for joint in (3, 2, 1)}
    path = write_parquet(tmp_path / "log.parquet", table)
    with pytest.raises(LogError, match="order of the joints is not known") as caught:
        read_log(path, mapping={"profile": "ros-jointstate"})
    assert set(caught.value.evidence["joints"]) == set(names.values())
    log = read_log(path, mapping={"profile": "ros-jointstate", "joints": list(names.values())})
    np.testing.assert_array_equal(whole_rows(log).torque[:, 2], COLUMNS["tau_3"])


@pytest.mark.parametrize("mapping", [{"profile": "kuka"}, {"profile": 7}, {"profile": None}])
def test_a_profile_that_does_not_exist_is_refused_with_the_list(mapping):
    with pytest.raises(LogError) as caught:
        fill_in(mapping, ["time"])
    assert caught.value.evidence["known"] == list(PROFILES)


@pytest.mark.parametrize("joints", [[], ["9"], "0", [0], [["0"]]])
def test_joints_that_the_file_does_not_have_are_refused(joints):
    with pytest.raises(LogError, match="joints that the file does not have"):
        fill_in({"profile": "ur-rtde", "joints": joints}, ["actual_q_0"])


def test_joints_without_a_profile_are_a_field_that_is_not_known(tmp_path):
    with pytest.raises(LogError, match="does not exist: joints"):
        read_log(write_csv(tmp_path / "log.csv", COLUMNS), mapping={"joints": ["1"]})
