"""A suggestion takes no count of rows for the clock, and nothing asked for or derived as measured."""

import numpy as np
import pytest

from tests.core.log.writers import swing, write_csv
from veritorque.core.errors import LogError
from veritorque.core.log.columns.plausible_units import plausible_readings
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

COLUMNS = swing(joints=2)
JOINTS = (0, 1)
TIME = COLUMNS["time"]
STAMPS = 1_700_000_000 + TIME


def suggested(path, table):
    with pytest.raises(LogError) as refusal:
        read_log(write_csv(path, table))
    return refusal.value.evidence["suggested_mappings"][0]


@pytest.mark.parametrize("counter", ["time_index", "ZeitIndex", "timestamp_nr", "Time Count"])
@pytest.mark.parametrize(
    ("clock", "named"),
    [
        ({"stamp": TIME}, "stamp"),
        ({"elapsed": TIME}, "elapsed"),
        ({"ZeitSek": STAMPS // 1, "ZeitNanoSek": STAMPS % 1 * 1e9}, "stamp_s"),
    ],
)
def test_a_count_of_rows_is_no_clock(counter, clock, named, tmp_path):
    joints = {f"{name}[{joint}]": COLUMNS[f"{name}_{joint + 1}"] for name in ("q", "tau") for joint in JOINTS}
    mapping = suggested(tmp_path / "log.csv", {counter: np.arange(len(TIME)) + 0.0} | clock | joints)
    assert mapping["time"] == {"column": named, "unit": "s"}


@pytest.mark.parametrize(
    ("derived", "measured"),
    [
        (("q_d", "tau_J_d"), ("q", "tau_J")),
        (("q_filtered", "tau_ext_hat_filtered"), ("q", "tau_J")),
        (("pos_smoothed", "torque_gravity"), ("act_pos", "act_torque")),
    ],
)
def test_what_is_called_by_fewer_words_is_the_measured_channel(derived, measured, tmp_path):
    table = {"t": TIME}
    for names, size in ((derived, 0.9), (measured, 1.0)):
        for name, channel in zip(names, ("q", "tau"), strict=True):
            table |= {f"field.{name}{joint}": size * COLUMNS[f"{channel}_{joint + 1}"] for joint in JOINTS}
    mapping = suggested(tmp_path / "log.csv", table)
    assert mapping["position"]["columns"] == [f"field.{measured[0]}{joint}" for joint in JOINTS]
    assert mapping["torque"]["columns"] == [f"field.{measured[1]}{joint}" for joint in JOINTS]


@pytest.mark.parametrize("clock", ["timestamp", "t", "elapsed"])
@pytest.mark.parametrize(
    ("position", "torque"),
    [("position.joint_", "effort.joint_"), ("state.q[{}]", "state.tau_J[{}]"), ("mp", "mt")],
)
def test_a_profile_is_suggested_with_the_clock_that_the_file_has(clock, position, torque, tmp_path):
    table = {clock: TIME}
    for stem, channel in ((position, "q"), (torque, "tau")):
        named = stem if "{}" in stem else stem + "{}"
        table |= {named.format(joint + 1): COLUMNS[f"{channel}_{joint + 1}"] for joint in JOINTS}
    mapping = suggested(tmp_path / "log.csv", table)
    assert mapping["time"] == {"column": clock, "unit": "s"}
    rows = whole_rows(read_log(tmp_path / "log.csv", mapping=mapping))
    np.testing.assert_allclose(rows.position[:, 1], COLUMNS["q_2"], atol=1e-9)


@pytest.mark.filterwarnings("error")
def test_a_single_value_beside_a_log_is_no_clock():
    assert plausible_readings("time", np.array([100.0])) == []
