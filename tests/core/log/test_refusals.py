import numpy as np
import pytest

from tests.core.log.writers import WRITERS, swing, write_csv, write_parquet
from veritorque.core.errors import LogError
from veritorque.core.log.reader import log_from_arrays, read_log


def spoiled(change):
    columns = swing()
    change(columns)
    return columns


def refusal(columns, tmp_path, form="Parquet", **options):
    name, write = WRITERS[form]
    with pytest.raises(LogError) as caught:
        read_log(write(tmp_path / name, columns), **options)
    assert caught.value.cause
    assert caught.value.evidence
    assert caught.value.remedy
    return caught.value


@pytest.mark.parametrize("form", ["CSV", "Parquet", "NPZ"])
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e300])
def test_a_column_without_a_usable_number_in_most_rows_is_refused_with_its_rows(form, value, tmp_path):
    def change(columns):
        columns["tau_2"][1000:2600] = value
        columns["q_1"][500] = value

    error = refusal(spoiled(change), tmp_path, form)
    assert error.cause.startswith("the column 'tau_2' holds 1600 values missing")
    assert error.cause.endswith("the first in row 1001; 1601 of 3000 rows lack a value")
    assert error.evidence["columns"] == {
        "tau_2": {"rows": 1600, "first_rows": [1001, 1002, 1003, 1004, 1005]},
        "q_1": {"rows": 1, "first_rows": [501]},
    }
    assert "write 0 in its whole column" in error.remedy


def test_values_that_are_missing_are_counted_over_the_whole_of_a_long_log(tmp_path):
    columns = swing(seconds=400.0)
    columns["q_1"][501::3] = columns["q_1"][502::3] = np.nan
    error = refusal(columns, tmp_path)
    assert error.evidence["columns"]["q_1"]["rows"] == 66_333
    assert error.evidence["rows_that_lack_a_value"] == 66_333


def test_the_remedy_for_a_torque_that_was_never_measured_leads_to_a_log(tmp_path):
    def change(columns):
        columns["tau_2"][:] = np.nan

    columns = spoiled(change)
    assert "write 0 in its whole column: its equations alone" in refusal(columns, tmp_path).remedy
    log = read_log(write_csv(tmp_path / "log.csv", columns | {"tau_2": np.zeros(3000)}))
    assert [(defect.kind, defect.joint) for defect in log.defects] == [("missing_torque", 2)]


def test_stamps_that_occur_twice_are_counted(tmp_path):
    def change(columns):
        columns["time"][[100, 200]] = columns["time"][[99, 199]]

    error = refusal(spoiled(change), tmp_path)
    assert error.cause == "stamps occur twice"
    assert (error.evidence["duplicate_stamps"], error.evidence["backward_steps"]) == (2, 0)
    assert error.evidence["first_row"] == 101


@pytest.mark.parametrize("step", [1e-7, 1e-300, 5e-324])
def test_stamps_closer_than_those_of_any_log_are_refused_although_they_span_seconds(step, tmp_path):
    def change(columns):
        columns["time"] = np.append(np.arange(1, len(columns["time"])) * step, 20.0)

    error = refusal(spoiled(change), tmp_path)
    assert error.evidence["median_step_s"] == pytest.approx(step, rel=1e-6)


def test_stamps_that_are_no_clock_are_refused_and_sorting_is_not_advised(tmp_path):
    """Sawtooth stamps: in runs too short to be any, and by them the motion would be rougher."""

    def change(columns):
        columns["time"] = columns["time"] % 0.1 + 1e-6 * np.arange(len(columns["time"]))

    error = refusal(spoiled(change), tmp_path)
    assert error.cause == "time goes backwards"
    assert error.evidence["backward_steps"] > 100
    assert "sort" not in error.remedy


@pytest.mark.parametrize("form", WRITERS)
@pytest.mark.parametrize("rows", [2, 99])
def test_a_log_of_a_few_rows_is_refused(form, rows, tmp_path):
    few = {name: values[:rows] for name, values in swing(joints=1).items()}
    error = refusal(few, tmp_path, form)
    assert error.evidence["rows"] == rows


def test_a_log_of_one_row_or_of_a_header_alone_is_refused(tmp_path):
    columns = swing()
    one = {name: values[:1] for name, values in columns.items()}
    assert refusal(one, tmp_path, "CSV").cause == "the log holds one row only"
    none = {name: values[:0] for name, values in columns.items()}
    assert refusal(none, tmp_path, "CSV").cause == "the log holds no rows"
    assert refusal(none, tmp_path, "Parquet").cause == "the log holds no rows"


def test_an_empty_file_is_refused(tmp_path):
    (tmp_path / "log.csv").touch()
    with pytest.raises(LogError, match="the log is empty"):
        read_log(tmp_path / "log.csv")


def test_less_than_a_second_is_refused(tmp_path):
    error = refusal(swing(seconds=0.9, rate_hz=1000.0), tmp_path)
    assert error.evidence["duration_s"] == pytest.approx(0.899)


def test_an_arm_that_never_moves_is_refused(tmp_path):
    def change(columns):
        for joint in (1, 2, 3):
            columns[f"q_{joint}"][:] = 0.25 * joint

    assert refusal(spoiled(change), tmp_path).evidence["positions"] == [0.25, 0.5, 0.75]


@pytest.mark.parametrize("channel", ["tau", "current"])
def test_efforts_that_are_zero_throughout_are_refused(channel, tmp_path):
    columns = {name.replace("tau", channel): values for name, values in swing().items()}
    for joint in (1, 2, 3):
        columns[f"{channel}_{joint}"][:] = 0.0
    assert "zero throughout" in refusal(columns, tmp_path).cause


def test_currents_of_zero_beside_measured_torques_are_no_reason_to_refuse(tmp_path):
    columns = swing(joints=1)
    columns["current_1"] = np.zeros(len(columns["time"]))
    assert read_log(write_parquet(tmp_path / "log.parquet", columns)).channels == (
        "position",
        "torque",
        "current",
    )


def test_text_in_a_needed_column_is_refused_with_what_was_found(tmp_path):
    path = write_csv(tmp_path / "log.csv", swing())
    lines = path.read_text(encoding="utf-8").splitlines()
    lines[500] = lines[500].rsplit(",", 1)[0] + ",fault"
    path.write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(LogError) as caught:
        read_log(path)
    assert caught.value.evidence == {"column": "tau_3", "found": "fault"}


def test_a_needed_parquet_column_of_text_is_refused(tmp_path):
    error = refusal(spoiled(lambda columns: columns.update(q_2=columns["q_2"].astype(str))), tmp_path)
    assert error.evidence["column"] == "q_2"


def test_two_columns_of_one_name_are_refused(tmp_path):
    path = write_csv(tmp_path / "log.csv", swing())
    path.write_text(path.read_text(encoding="utf-8").replace("q_2", "q_1", 1), encoding="utf-8")
    with pytest.raises(LogError) as caught:
        read_log(path)
    assert caught.value.evidence["duplicates"] == ["q_1"]


def test_numbers_without_a_header_are_refused_until_their_columns_are_mapped_by_number(tmp_path):
    path = write_csv(tmp_path / "log.csv", swing())
    path.write_text(path.read_text(encoding="utf-8").split("\n", 1)[1], encoding="utf-8")
    with pytest.raises(LogError, match="the file has no header"):
        read_log(path)


def test_more_rows_than_can_be_studied_are_refused_from_the_footer(tmp_path, monkeypatch):
    monkeypatch.setattr("veritorque.core.log.formats.table.MAX_ROWS", 2999)
    assert refusal(swing(), tmp_path).evidence == {"rows": 3000, "at_most": 2999}


def test_arrays_of_different_lengths_are_refused(tmp_path):
    columns = swing(joints=1)
    np.savez(tmp_path / "log.npz", time=columns["time"], q=columns["q_1"][:-1], tau=columns["tau_1"])
    with pytest.raises(LogError, match="different lengths"):
        read_log(tmp_path / "log.npz")


def test_arrays_given_directly_pass_the_same_checks():
    time = np.arange(500) / 250.0
    position = np.sin(np.outer(time, [3.0, 4.0]))
    with pytest.raises(LogError, match="disagree in shape"):
        log_from_arrays("short", time, position, position[:-1])
    with pytest.raises(LogError, match="neither torque nor current"):
        log_from_arrays("none", time, position, None)
    with pytest.raises(LogError, match="no channel 'voltage'"):
        log_from_arrays("volts", time, position, position, voltage=position)
    with pytest.raises(LogError, match="time goes backwards"):
        log_from_arrays("back", time % 0.1, position, position)
    assert log_from_arrays("fine", time, position, None, current=position).channels == ("position", "current")


def test_the_order_of_refusals_does_not_depend_on_the_format(tmp_path):
    columns = spoiled(lambda columns: columns["q_1"].__setitem__(slice(100, 2900), np.nan))
    kinds = {str(refusal(columns, tmp_path, form)) for form in WRITERS}
    assert len(kinds) == 1


def test_parquet_that_is_damaged_behind_a_sound_footer_is_refused(tmp_path):
    path = write_parquet(tmp_path / "log.parquet", swing())
    damaged = bytearray(path.read_bytes())
    damaged[4:2000] = bytes(1996)
    path.write_bytes(bytes(damaged))
    with pytest.raises(LogError, match="Parquet file cannot be read"):
        read_log(path)


def leapt(by, rows=slice(1000, None)):
    def change(columns):
        columns["q_2"][rows] += by

    return spoiled(change)


@pytest.mark.parametrize("by", [0.11, -0.5, 3.0, 180.0])
def test_a_position_that_leaps_while_others_move_on_is_refused_with_row_and_size(by, tmp_path):
    error = refusal(leapt(by), tmp_path)
    assert set(error.evidence) == {"joint_2"}
    assert error.evidence["joint_2"]["jumps"] == 1
    assert error.evidence["joint_2"]["largest_rad"] == pytest.approx(abs(by), abs=0.06)
    assert "unwrap" in error.remedy or "leap" in error.remedy


@pytest.mark.parametrize("row", [32_766, 32_767, 32_768, 32_769, 32_772])
@pytest.mark.parametrize("by", [0.5, 3.0])
def test_a_leap_where_the_log_is_read_piece_by_piece_is_counted_once(row, by, tmp_path):
    columns = swing(seconds=200.0)
    columns["q_2"][row:] += by
    found = refusal(columns, tmp_path).evidence["joint_2"]
    assert (found["jumps"], found["first_row"]) == (1, row + 1)


def test_the_row_of_a_leap_counts_the_rows_that_were_left_out(tmp_path):
    columns = leapt(0.5)
    for name, values in columns.items():
        if name != "time":
            values[:40] = 0.0
    assert refusal(columns, tmp_path).evidence["joint_2"]["first_row"] == 1001


def test_a_stretch_that_was_not_recorded_is_no_leap_of_a_joint(tmp_path):
    """Every moving joint is farther on at once, though the stamps go on evenly."""
    columns = swing()
    kept = {name: np.delete(values, slice(700, 760)) for name, values in columns.items()}
    kept["time"] = columns["time"][: len(kept["time"])]
    write_csv(tmp_path / "log.csv", kept)
    assert read_log(tmp_path / "log.csv").samples == len(kept["time"])


def test_too_few_rows_over_a_long_time_are_told_how_many_rows_it_takes(tmp_path):
    error = refusal(swing(seconds=8.0, rate_hz=7.5), tmp_path)
    assert error.evidence == {"rows": 60, "at_least": 100}
    assert "100 rows" in error.remedy


@pytest.mark.parametrize(("unit", "factor"), [("ms", 1e3), ("us", 1e6), ("ns", 1e9)])
def test_stamps_of_the_default_name_that_are_no_seconds_ask_for_their_unit(unit, factor, tmp_path):
    columns = swing()
    columns["time"] = columns["time"] * factor
    error = refusal(columns, tmp_path)
    assert error.cause.startswith("the unit of 'time' is not declared")
    (suggested,) = error.evidence["suggested_mappings"]
    assert suggested["time"] == {"column": "time", "unit": unit}
    log = read_log(tmp_path / "log.parquet", mapping={"time": suggested["time"]})
    assert log.rate_hz == pytest.approx(250.0)


def test_seconds_that_are_far_apart_are_read_where_they_are_declared(tmp_path):
    columns = swing(seconds=400.0, rate_hz=3.0)
    assert "too long for s" in refusal(columns, tmp_path).cause
    log = read_log(tmp_path / "log.parquet", mapping={"time": {"column": "time", "unit": "s"}})
    assert log.rate_hz == pytest.approx(3.0)
