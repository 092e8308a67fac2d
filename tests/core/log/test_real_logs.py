"""What is known of four public logs, from the notes beside them, must be what the reader finds."""

import json
import time
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

DATA = Path(__file__).parents[3].parent / "shared" / "data"
pytestmark = pytest.mark.skipif(
    not DATA.is_dir(), reason="the public logs are not in ../shared/data: see its README for their sources"
)

RUNS = sorted(DATA.glob("*/runs/*.parquet"))


def defects(log, kind):
    return [defect for defect in log.defects if defect.kind == kind]


@pytest.mark.parametrize("path", RUNS, ids=lambda path: f"{path.parts[-3]}-{path.stem}")
def test_every_public_log_is_read_as_its_notes_say(path):
    notes = json.loads((path.parents[1] / "meta.json").read_text(encoding="utf-8"))
    log = read_log(path)
    for run in notes.get("runs", []):
        if run["file"].endswith(path.name):
            assert log.samples == run["samples"]
            assert log.duration == pytest.approx(run["duration_s"], abs=0.01)
            assert 1.0 / log.rate_hz == pytest.approx(run["dt_median_s"], rel=1e-3)
            assert sum(gap.count for gap in defects(log, "gap")) == run["gaps_gt_3dt"]
    assert {"position", "torque"} <= set(log.channels)
    table = pq.read_table(path)
    assert log.samples == table.num_rows
    np.testing.assert_array_equal(whole_rows(log).torque[:, 0], table["tau_1"].to_numpy().astype(float))


@pytest.mark.parametrize("path", RUNS, ids=lambda path: f"{path.parts[-3]}-{path.stem}")
def test_no_defect_is_reported_of_a_public_log_that_does_not_have_it(path):
    found = {defect.kind for defect in read_log(path).defects}
    assert not found & {"saturation", "slow_rate", "implausible_unit", "missing_torque"}


def test_the_log_of_a_servo_axis_keeps_what_its_controller_asked_for():
    path = DATA / "emps" / "runs" / "track.parquet"
    log, table = read_log(path), pq.read_table(path)
    assert log.channels == ("position", "torque", "position_ref", "command")
    for channel, column in (("position_ref", "position_ref_1"), ("command", "command_1")):
        np.testing.assert_array_equal(getattr(whole_rows(log), channel)[:, 0], table[column].to_numpy())


def test_the_panda_log_has_gaps_jitter_and_repeated_rows():
    log = read_log(DATA / "franka_panda" / "runs" / "traj1.parquet")
    (repeated,) = defects(log, "repeated_rows")
    assert 0.05 < repeated.count / log.samples < 0.065
    (gap,) = defects(log, "gap")
    assert "longest 0.00881 s" in gap.statement
    assert log.segments == ((0, log.samples),)
    assert len(defects(log, "jitter")) == 1


def test_the_ur10e_stamps_vary_and_are_not_called_gaps():
    log = read_log(DATA / "ur10e_open" / "runs" / "fourier_30s_12h.parquet")
    (jitter,) = defects(log, "jitter")
    assert "longest is 13 ms" in jitter.statement
    assert not defects(log, "gap")


def test_the_ur10e_rests_before_and_after_its_motion():
    log = read_log(DATA / "ur10e_open" / "runs" / "fourier_30s_12h.parquet")
    for rest in defects(log, "standstill"):
        assert rest.intervals[0][0] == 0.0
        assert 4.5 < rest.intervals[0][1] < 7.2
        assert rest.intervals[-1][1] == pytest.approx(log.duration)
        assert rest.count < log.samples
    assert [rest.joint for rest in defects(log, "standstill")] == [1, 2, 3, 4, 5, 6]


def test_in_a_jointwise_run_only_the_moved_joint_is_not_at_rest():
    log = read_log(DATA / "ur10e_open" / "runs" / "jointwise_j4.parquet")
    resting = {rest.joint: rest.count / log.samples for rest in defects(log, "standstill")}
    assert resting.pop(4) < 0.1
    assert min(resting.values()) > 0.85


def test_the_tx40_rests_at_its_end_at_five_kilohertz():
    log = read_log(DATA / "staubli_tx40" / "runs" / "run1.parquet")
    rests = defects(log, "standstill")
    assert len(rests) == 6
    for rest in rests:
        assert rest.intervals[-1][0] < 39_897 / 5000.0
        assert rest.intervals[-1][1] == pytest.approx(log.duration, abs=0.01)
    assert not defects(log, "jitter")
    assert not defects(log, "outliers")


def test_the_rokae_log_is_even_and_its_encoder_coarse():
    log = read_log(DATA / "rokae_xmate3" / "runs" / "excit.parquet")
    assert not defects(log, "jitter")
    assert all("0.0001 rad" in defect.statement for defect in defects(log, "quantisation"))
    assert log.ignored_columns == tuple(f"tau_motor_{joint}" for joint in range(1, 8))


def test_half_a_minute_of_seven_joints_is_read_at_once():
    """It takes 0.05 s of CPU; the bound leaves a factor of four for type checks and a busy machine."""
    path = DATA / "rokae_xmate3" / "runs" / "excit.parquet"
    read_log(path)
    start = time.process_time()
    read_log(path)
    assert time.process_time() - start < 0.2


@pytest.mark.parametrize(
    ("run", "profile", "names"),
    [
        (
            "ur10e_open/runs/fourier_30s_12h.parquet",
            "ur-rtde",
            {"time": "timestamp", "q": "actual_q_{}", "qd": "actual_qd_{}", "current": "actual_current_{}"},
        ),
        (
            "franka_panda/runs/traj1.parquet",
            "franka",
            {"time": "time", "q": "state.q[{}]", "qd": "state.dq[{}]", "tau": "state.tau_J[{}]"},
        ),
    ],
)
def test_a_public_log_under_the_names_of_its_recorder_is_the_same_log(run, profile, names, tmp_path):
    known = read_log(DATA / run)
    table = pq.read_table(DATA / run)
    milliseconds = 1e3 if profile == "franka" else 1.0
    renamed = {names["time"]: milliseconds * table["time"].to_numpy()}
    for prefix in list(names)[1:]:
        for joint in range(known.joints, 0, -1):
            renamed[names[prefix].format(joint - 1)] = table[f"{prefix}_{joint}"].to_numpy()
    pq.write_table(pa.table(renamed), tmp_path / "log.parquet")
    found = read_log(tmp_path / "log.parquet", mapping={"profile": profile})
    np.testing.assert_array_equal(whole_rows(found).position, whole_rows(known).position)
    np.testing.assert_allclose(whole_rows(found).time, whole_rows(known).time, rtol=1e-12)
    assert found.rate_hz == pytest.approx(known.rate_hz, rel=1e-9)
