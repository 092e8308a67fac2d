from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.core.log.writers import swing, write_parquet
from veritorque.core.errors import LogError
from veritorque.core.log.channels import UNITS
from veritorque.core.log.columns.mapping import parse_mapping
from veritorque.core.log.columns.plausible_units import plausible_readings
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log


def renamed(names, **scales):
    """Give the swinging arm's columns other names, and other units by a factor."""
    columns = swing(joints=2)
    return {names.get(name, name): values * scales.get(name, 1.0) for name, values in columns.items()}


def rows_of(tmp_path, columns, mapping):
    return whole_rows(read_log(write_parquet(tmp_path / "log.parquet", columns), mapping=mapping))


def refusal(tmp_path, columns, mapping=None):
    with pytest.raises(LogError) as caught:
        read_log(write_parquet(tmp_path / "log.parquet", columns), mapping=mapping)
    return caught.value


def test_declared_units_become_si(tmp_path):
    names = {"time": "t", "q_1": "a", "q_2": "b", "tau_1": "m1", "tau_2": "m2"}
    columns = renamed(names, time=1e3, q_1=180 / np.pi, q_2=180 / np.pi, tau_1=1e3, tau_2=1e3)
    mapping = {
        "time": {"column": "t", "unit": "ms"},
        "position": {"columns": ["a", "b"], "unit": "deg"},
        "torque": {"columns": ["m1", "m2"], "unit": "mN m"},
    }
    plain, mapped = rows_of(tmp_path, swing(joints=2), None), rows_of(tmp_path, columns, mapping)
    np.testing.assert_allclose(mapped.time, plain.time, rtol=1e-14)
    np.testing.assert_allclose(mapped.position, plain.position, rtol=1e-14)
    np.testing.assert_allclose(mapped.torque, plain.torque, rtol=1e-14)


def test_counts_become_rad_by_scale_and_offset_joint_by_joint(tmp_path):
    columns = swing(joints=2)
    columns["e1"], columns["e2"] = np.round(columns["q_1"] * 1e4), np.round(columns["q_2"] * 2e4)
    mapping = {
        "position": {"columns": ["e1", "e2"], "unit": "counts", "scale": [1e-4, 5e-5], "offset": [0.0, 1.5]}
    }
    position = rows_of(tmp_path, columns, mapping).position
    np.testing.assert_allclose(position[:, 0], columns["q_1"], atol=5.1e-5)
    np.testing.assert_allclose(position[:, 1], columns["q_2"] + 1.5, atol=2.6e-5)


def test_kelvin_becomes_degrees_celsius(tmp_path):
    columns = swing(joints=1)
    columns["warm"] = np.full(3000, 300.0)
    mapping = {"temperature": {"columns": ["warm"], "unit": "K"}}
    assert rows_of(tmp_path, columns, mapping).temperature[0, 0] == pytest.approx(26.85)


def test_a_declared_rate_is_a_uniform_clock_where_there_is_no_time(tmp_path):
    columns = swing(joints=1)
    time = columns.pop("time")
    rows = rows_of(tmp_path, {**columns, "time": time}, {"time": None, "rate_hz": 250.0})
    np.testing.assert_allclose(rows.time, time, rtol=1e-15)


def test_a_rate_beside_a_time_column_is_refused(tmp_path):
    assert "as well" in refusal(tmp_path, swing(), {"rate_hz": 250.0}).cause


def test_a_channel_mapped_to_null_is_left_out_and_listed(tmp_path):
    columns = swing(joints=2)
    columns["temperature_1"] = np.full(3000, np.nan)
    columns["temperature_2"] = np.full(3000, np.nan)
    path = write_parquet(tmp_path / "log.parquet", columns)
    assert read_log(path, mapping={"temperature": None}).ignored_columns == ("temperature_1", "temperature_2")


@pytest.mark.parametrize("named", [["temperature_1"], ["temperature_2"], ["temperature"]])
def test_one_sensor_for_an_arm_is_left_out_and_listed_unless_it_is_mapped(tmp_path, named):
    columns = swing(joints=2) | {name: np.full(3000, 30.0) for name in named}
    path = write_parquet(tmp_path / "log.parquet", columns)
    read = read_log(path)
    assert list(read.ignored_columns) == named
    assert "temperature" not in read.channels
    with pytest.raises(LogError, match="temperature does not have one column per joint"):
        read_log(path, mapping={"temperature": {"columns": named, "unit": "degC"}})


@pytest.mark.parametrize("named", [["current_1"], ["current_3"], ["current_1", "current_3"]])
def test_currents_of_some_joints_beside_all_torques_are_left_out_and_listed(tmp_path, named):
    columns = swing(joints=3) | {name: np.full(3000, 2.0) for name in named}
    path = write_parquet(tmp_path / "log.parquet", columns)
    read = read_log(path)
    assert list(read.ignored_columns) == named
    assert "current" not in read.channels
    with pytest.raises(LogError, match="current"):
        read_log(path, mapping={"torque": None})


def test_an_undeclared_unit_is_answered_with_its_plausible_readings(tmp_path):
    columns = renamed({"q_1": "base", "q_2": "elbow"}, q_1=170 / 1.3, q_2=170 / 1.3)
    error = refusal(tmp_path, columns, {"position": {"columns": ["base", "elbow"]}})
    readings = error.evidence["plausible_readings"]["base"]
    assert readings[0].startswith("deg: values reach")
    assert error.remedy.endswith("most plausibly deg")


def test_missing_positions_are_answered_with_what_is_there_and_what_it_might_be(tmp_path):
    error = refusal(tmp_path, renamed({"q_1": "q1", "q_2": "q2"}, q_1=100.0, q_2=100.0))
    assert error.evidence["looked_for"] == ["q_1", "q_2", "..."]
    assert error.evidence["columns"] == ["time", "q1", "q2", "tau_1", "tau_2"]
    assert "q1" in error.evidence["nearest"]["q_1"]
    assert error.evidence["plausible_readings"]["q1"][0].startswith("deg")


@pytest.mark.parametrize("missing", ["time", "q_2", "tau_1"])
def test_a_missing_default_column_is_named(missing, tmp_path):
    columns = swing(joints=3)
    columns.pop(missing)
    assert missing in refusal(tmp_path, columns).cause


def test_a_log_without_any_effort_is_refused(tmp_path):
    columns = {name: values for name, values in swing().items() if not name.startswith("tau")}
    assert "no column for torque" in refusal(tmp_path, columns).cause


def test_fewer_torques_than_joints_are_refused_with_the_counts(tmp_path):
    columns = swing(joints=3)
    columns.pop("tau_3")
    assert refusal(tmp_path, columns).evidence["columns"] == {"position": 3, "torque": 2}


TWO = {"columns": ["a", "b"], "unit": "rad"}


@pytest.mark.parametrize(
    ("mapping", "words"),
    [
        ([], "the mapping is not an object"),
        ({"speed": {}}, "does not exist: speed"),
        (
            {"position": {"columns": ["q_1"], "units": "rad"}},
            "position holds a field that does not exist: units",
        ),
        ({"position": {"columns": ["q_1"], "unit": "furlong"}}, "position: unit is not one"),
        ({"position": {"columns": ["q_1"], "unit": ["rad", "deg"]}}, "position: unit is not one"),
        ({"position": {"columns": ["q_1"], "unit": "counts"}}, "position: scale is missing"),
        ({"position": {"columns": ["q_1"], "unit": "rad", "scale": 0}}, "position: scale is zero"),
        ({"position": {"columns": ["q_1"], "unit": "rad", "scale": True}}, "scale is not a number"),
        (
            {"position": {"columns": ["q_1"], "unit": "rad", "offset": float("nan")}},
            "position: offset is not finite",
        ),
        ({"position": {"columns": ["q_1", "q_1"], "unit": "rad"}}, "twice"),
        ({"position": {"columns": "q_1"}}, "position: columns is not a list"),
        ({"position": {"columns": []}}, "position: columns holds 0 entries"),
        ({"time": {"columns": ["t"]}}, "time holds a field that does not exist: columns"),
        ({"torque": {**TWO, "linkage": []}}, "torque holds a field that does not exist: linkage"),
        ({"position": {**TWO, "linkage": {"joint": 2}}}, "position: linkage is not a list"),
        ({"position": {**TWO, "linkage": [{"joint": 2}]}}, "linkage of position: adds is missing"),
        ({"position": {**TWO, "linkage": [{"joint": 3, "adds": 1}]}}, "linkage of position: joint is"),
        ({"position": {**TWO, "linkage": [{"joint": 2, "adds": 1, "factor": 0}]}}, "factor is out of range"),
        (
            {"position": {**TWO, "linkage": [{"joint": 2, "adds": 1}, {"joint": 1, "adds": 2}]}},
            "position: linkage leaves a joint without values of its own",
        ),
        ({"rate_hz": -1.0}, "rate_hz is out of range"),
        ({"rate_hz": True}, "rate_hz is not a number"),
    ],
)
def test_a_mapping_that_is_not_understood_is_refused_by_the_name_of_what_is_wrong(mapping, words):
    with pytest.raises(LogError) as caught:
        parse_mapping(mapping)
    assert words in caught.value.cause


def test_an_unknown_field_is_answered_with_the_known_ones_and_the_nearest():
    with pytest.raises(LogError) as caught:
        parse_mapping({"postion": {}})
    assert caught.value.evidence["nearest"] == ["position", "position_ref"]
    assert set(UNITS) <= set(caught.value.evidence["known"])


json_values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-5, 5)
    | st.floats()
    | st.sampled_from(["q_1", "rad", "N m", "counts", ""]),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(["columns", "column", "unit", "scale", "offset", "linkage", "joint", "adds"]),
            inner,
            max_size=4,
        )
    ),
    max_leaves=8,
)


@given(st.dictionaries(st.sampled_from([*UNITS, "rate_hz", "other"]), json_values, max_size=4))
def test_whatever_json_is_sent_as_a_mapping_is_understood_or_refused(document):
    with suppress(LogError):
        parse_mapping(document)


@pytest.mark.parametrize(
    ("channel", "values", "unit"),
    [
        ("position", np.linspace(-1.5, 1.5, 50), "rad"),
        ("position", np.linspace(-170.3, 169.7, 50), "deg"),
        ("position", np.arange(0.0, 90000.0, 1000.0), "counts"),
        ("velocity", np.linspace(-90.5, 90.5, 50), "deg/s"),
        ("torque", np.linspace(-40.5, 40.5, 50), "N m"),
        ("current", np.linspace(-2500.5, 2500.5, 50), "mA"),
        ("temperature", np.linspace(299.5, 310.5, 50), "K"),
        ("time", np.arange(50) * 4.1, "ms"),
    ],
)
def test_usual_numbers_are_read_in_their_usual_unit_first(channel, values, unit):
    assert plausible_readings(channel, values)[0].split(":")[0] == unit
