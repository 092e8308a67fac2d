"""Angles that a recorder wrapped are followed over the turns, so that they are those of the motion."""

import numpy as np
import pytest

from tests.core.log.writers import WRITERS, swing, write_csv, write_parquet
from veritorque.core.errors import LogError
from veritorque.core.log.model import JointLog, whole_rows
from veritorque.core.log.reader import log_from_arrays, read_log

TURN = 2.0 * np.pi


def moved(log: JointLog) -> np.ndarray:
    return np.diff(whole_rows(log).position, axis=0)


def rounds(seconds: float = 12.0) -> np.ndarray:
    """Give angles of three joints that go through several turns, rad."""
    columns = swing(seconds=seconds)
    return np.column_stack([4.0 * columns[f"q_{joint}"] for joint in (1, 2, 3)])


@pytest.mark.parametrize("form", WRITERS)
@pytest.mark.parametrize("low", [0.0, -0.5, -0.97], ids=["from zero", "half a turn to either side", "odd"])
@pytest.mark.parametrize(("unit", "turn"), [("deg", 360.0), ("rad", TURN)])
def test_the_motion_of_a_wrapped_log_is_that_of_the_log_before(form, low, unit, turn, tmp_path):
    name, write = WRITERS[form]
    angles = rounds()
    wrapped = (angles * turn / TURN - low * turn) % turn + low * turn
    columns = swing() | {f"q_{joint + 1}": wrapped[:, joint] for joint in range(3)}
    mapping = {"position": {"columns": ["q_1", "q_2", "q_3"], "unit": unit}}
    log = read_log(write(tmp_path / name, columns), mapping=mapping)
    np.testing.assert_allclose(moved(log), np.diff(angles, axis=0), atol=1e-9)
    leaps = np.count_nonzero(np.abs(np.diff(wrapped, axis=0)) > 0.5 * turn, axis=0)
    found = [(one.joint, one.count) for one in log.defects if one.kind == "wrapped_angle"]
    assert found == [(joint + 1, leaps[joint]) for joint in range(3) if leaps[joint]]
    assert found


def test_degrees_that_were_declared_as_rad_are_followed_in_degrees(tmp_path):
    angles = np.degrees(rounds())
    columns = swing() | {f"q_{joint + 1}": angles[:, joint] % 360.0 for joint in range(3)}
    log = read_log(write_csv(tmp_path / "log.csv", columns))
    np.testing.assert_allclose(moved(log), np.diff(angles, axis=0), atol=1e-9)
    statements = [one.statement for one in log.defects if one.kind == "wrapped_angle"]
    assert all("declared as rad" in statement for statement in statements)


def test_a_joint_that_rests_where_it_is_wrapped_does_not_leap(tmp_path):
    columns, rng = swing(), np.random.default_rng(4)
    rest = np.r_[np.zeros(1500), 0.4 * (1.0 - np.cos(np.arange(1500) / 100.0))]
    noisy = rest + 1e-4 * rng.normal(size=3000)
    log = read_log(write_csv(tmp_path / "log.csv", columns | {"q_2": noisy % TURN}))
    np.testing.assert_allclose(moved(log)[:, 1], np.diff(noisy), atol=1e-9)


def test_angles_are_followed_between_the_rows_that_have_them(tmp_path):
    """Two recorders of one rate write in turn, so that every second row lacks its positions."""
    columns, angles = swing(), rounds()
    rows = {"time": np.arange(6000) / 500.0}
    for name, values in columns.items():
        rows.setdefault(name, np.repeat(values, 2))
    for joint in range(3):
        rows[f"q_{joint + 1}"] = np.repeat(angles[:, joint] % TURN, 2)
        rows[f"q_{joint + 1}"][3::7] = np.nan
    log = read_log(write_csv(tmp_path / "log.csv", rows))
    kept = np.setdiff1d(np.arange(6000), np.arange(3, 6000, 7))
    np.testing.assert_allclose(moved(log), np.diff(np.repeat(angles, 2, axis=0)[kept], axis=0), atol=1e-9)


@pytest.mark.parametrize("row", [32_764, 32_766, 32_767, 32_768, 32_769, 32_772])
def test_a_turn_where_the_log_is_read_piece_by_piece_is_taken_out_once(row, tmp_path):
    columns = swing(seconds=200.0)
    turning = np.linspace(0.0, 2.0 * TURN, 50_000)
    turning += 2.0 * TURN + 1e-6 - turning[row]
    before = turning % TURN
    log = read_log(write_parquet(tmp_path / "log.parquet", columns | {"q_2": before}))
    leaps = np.flatnonzero(np.abs(np.diff(before)) > 3.0)
    assert [one.count for one in log.defects if one.kind == "wrapped_angle"] == [len(leaps)]
    np.testing.assert_allclose(moved(log)[:, 1], np.diff(turning), atol=1e-9)
    part = log.source.rows(row - 3, row + 3).position[:, 1]
    np.testing.assert_allclose(np.diff(part), np.diff(turning[row - 3 : row + 3]), atol=1e-9)


def test_a_reference_that_is_wrapped_elsewhere_is_taken_to_the_same_turn():
    angles, time = rounds(), swing()["time"]
    ahead = angles + 0.01
    log = log_from_arrays(
        "wrapped", time, angles % TURN, np.sin(angles), position_ref=(ahead + 2.0) % TURN - 2.0
    )
    rows = whole_rows(log)
    np.testing.assert_allclose(rows.position_ref - rows.position, 0.01, atol=1e-9)


def test_a_slide_that_leaps_by_as_many_metres_has_no_turns(tmp_path):
    columns = swing()
    columns["q_2"][1000:] += TURN
    mapping = {"position": {"columns": ["q_1", "q_2", "q_3"], "unit": ["rad", "m", "rad"]}}
    with pytest.raises(LogError, match="leaps"):
        read_log(write_csv(tmp_path / "log.csv", columns), mapping=mapping)


def test_degrees_declared_as_rad_that_move_by_six_a_row_stay_as_they_are(tmp_path):
    """Steps of about 6.28 of a fast joint are no turns, since its other steps are as long."""
    columns = swing()
    fast = np.cumsum(6.3 * np.sin(np.arange(3000) / 150.0))
    log = read_log(write_csv(tmp_path / "log.csv", columns | {"q_2": fast}))
    assert "wrapped_angle" not in {one.kind for one in log.defects}
    np.testing.assert_allclose(whole_rows(log).position[:, 1], fast)


@pytest.mark.parametrize("step", [6.2, 6.28, 6.35])
def test_zeros_before_a_log_of_degrees_that_were_declared_as_rad_are_no_turn(step, tmp_path):
    """One turn less in rad is 6.28 degrees off."""
    columns = {name: values.copy() for name, values in swing().items()}
    columns["q_2"] = np.degrees(columns["q_2"] - columns["q_2"][30]) + step
    for name in columns.keys() - {"time"}:
        columns[name][:30] = 0.0
    log = read_log(write_csv(tmp_path / "log.csv", columns))
    assert "wrapped_angle" not in {one.kind for one in log.defects}
    np.testing.assert_allclose(whole_rows(log).position[:, 1], columns["q_2"][30:])


@pytest.mark.parametrize("glitch", [5.8, -6.0])
def test_a_sample_that_is_off_by_nearly_a_turn_is_an_outlier(glitch, tmp_path):
    columns = swing()
    columns["q_2"][1234] += glitch
    log = read_log(write_csv(tmp_path / "log.csv", columns))
    assert [(one.kind, one.joint) for one in log.defects if one.channel == "position"] == [("outliers", 2)]
