"""Hold the table of channels to what reads it, and the reference channels to being read, shown and kept."""

import json
from dataclasses import fields, replace

import numpy as np
import pytest

from tests.core.estimate.worlds import log_of, planar_robot, true_parameters
from tests.core.estimate.worlds import swing as swing_of
from tests.core.log.writers import swing, write_csv, write_parquet
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import LogError
from veritorque.core.log.channels import CHANNELS, JOINT_CHANNELS, TIME
from veritorque.core.log.check import check_log
from veritorque.core.log.columns.mapping import parse_mapping
from veritorque.core.log.columns.plausible_units import plausible_readings
from veritorque.core.log.columns.profiles import PROFILES
from veritorque.core.log.model import LogRows, rows_at, whole_rows
from veritorque.core.log.preview import preview
from veritorque.core.log.reader import log_from_arrays, read_log
from veritorque.core.study import IdentifyRequest, identify

JOINTS = 2
REFERENCES = [channel for channel in JOINT_CHANNELS if channel.need == "reference"]


def with_references(joints=JOINTS):
    columns = swing(joints=joints)
    for number, channel in enumerate(REFERENCES, start=1):
        for joint in range(1, joints + 1):
            columns[f"{channel.prefix}_{joint}"] = number + np.cos(joint * columns["time"])
    return columns


def everything():
    columns = with_references()
    for channel in JOINT_CHANNELS:
        for joint in range(1, JOINTS + 1):
            columns.setdefault(f"{channel.prefix}_{joint}", 1.0 + np.sin(joint * columns["time"]))
    return columns


@pytest.mark.parametrize("channel", JOINT_CHANNELS, ids=lambda channel: channel.name)
def test_every_channel_of_the_table_is_read_checked_previewed_mapped_and_kept(channel, tmp_path):
    columns = everything()
    wanted = np.column_stack([columns[f"{channel.prefix}_{joint}"] for joint in range(1, JOINTS + 1)])
    path = write_parquet(tmp_path / "log.parquet", columns)
    log = read_log(path)
    rows = whole_rows(log)
    assert log.channels == tuple(own.name for own in JOINT_CHANNELS)
    np.testing.assert_array_equal(getattr(rows, channel.name), wanted)
    np.testing.assert_array_equal(getattr(rows_at(rows, slice(5, 9)), channel.name), wanted[5:9])
    (reach,) = (reach for reach in check_log(path).reach if reach.channel == channel.name)
    np.testing.assert_array_equal([reach.low, reach.high], [wanted.min(axis=0), wanted.max(axis=0)])
    drawn = preview(log, [channel.name], points=100)
    assert drawn.values.shape[1] == JOINTS
    assert np.nanmax(drawn.values) == wanted.max()
    for unit in channel.quantity.units:
        request = {"columns": ["a", "b"], "unit": unit.name} | ({"scale": 1e-3} if unit.needs_scale else {})
        assert parse_mapping({channel.name: request}).channels[channel.name].units == (unit.name,) * 2
        assert any(
            reading.startswith(f"{unit.name}: ")
            for reading in plausible_readings(channel.name, np.full(3, np.ceil(unit.usual[0] + 1e-9)))
        )


def test_rows_and_profiles_know_the_channels_of_the_table_and_no_others():
    assert {field.name for field in fields(LogRows)} == set(CHANNELS)
    for profile in PROFILES.values():
        for name, patterns in profile.channels.items():
            units = {unit.name for unit in CHANNELS[name].quantity.units}
            assert {pattern.unit for pattern in patterns} <= units | {""}


def test_the_first_units_are_si_and_names_are_taken_once():
    for channel in CHANNELS.values():
        first = channel.quantity.units[0]
        assert (first.name, first.factor, first.offset) == (channel.quantity.revolute, 1.0, 0.0)
    assert len({channel.prefix for channel in CHANNELS.values()}) == len(CHANNELS)
    assert all(channel.about for channel in CHANNELS.values())
    assert [channel.name for channel in CHANNELS.values() if not channel.per_joint] == [TIME]


@pytest.mark.parametrize(("name", "write"), [("log.csv", write_csv), ("log.parquet", write_parquet)])
def test_reference_channels_round_trip_through_a_file_and_arrays(name, write, tmp_path):
    log = read_log(write(tmp_path / name, with_references()))
    rows = whole_rows(log)
    again = log_from_arrays("again", rows.time, **rows.channels())
    for channel, values in rows.channels().items():
        np.testing.assert_array_equal(getattr(whole_rows(again), channel), values)
    assert log.channels == again.channels == ("position", "torque", *(own.name for own in REFERENCES))


def test_a_log_has_the_same_defects_and_segments_with_references_as_without(tmp_path):
    columns = with_references()
    columns["q_1"][500] += 2.0
    bare = {name: values for name, values in columns.items() if "ref" not in name and "command" not in name}
    logs = [
        read_log(write_parquet(tmp_path / f"{number}.parquet", table))
        for number, table in enumerate((columns, bare))
    ]
    assert logs[0].defects
    assert logs[0].defects == logs[1].defects
    assert logs[0].segments == logs[1].segments


@pytest.mark.parametrize("channel", REFERENCES, ids=lambda channel: channel.name)
def test_a_wrong_unit_of_a_reference_is_refused_in_words(channel):
    with pytest.raises(LogError) as caught:
        parse_mapping({channel.name: {"columns": ["a", "b"], "unit": "furlong"}})
    assert channel.name in caught.value.cause
    assert caught.value.evidence["known"] == [unit.name for unit in channel.quantity.units]
    assert channel.quantity.revolute in caught.value.remedy


def test_a_reference_is_mapped_with_its_unit_and_becomes_si(tmp_path):
    columns = with_references()
    columns["target_1"], columns["target_2"] = (np.rad2deg(columns[f"q_{joint}"]) for joint in (1, 2))
    mapping = {"position_ref": {"columns": ["target_1", "target_2"], "unit": "deg"}, "command": None}
    log = read_log(write_parquet(tmp_path / "log.parquet", columns), mapping=mapping)
    rows = whole_rows(log)
    np.testing.assert_allclose(rows.position_ref, rows.position, rtol=1e-14)
    assert rows.command is None
    assert {"command_1", "position_ref_1"} <= set(log.ignored_columns)


@pytest.mark.parametrize("kept", [("command_1",), ("command_2",), ("torque_ref_1", "torque_ref_2")])
def test_default_names_of_a_reference_that_mean_something_else_are_left_alone(kept, tmp_path):
    """One column of two joints is something else, and so is what the mapping gives to another channel."""
    columns = swing(joints=JOINTS) | {name: np.full(3000, 7.0) for name in kept}
    mapping = None
    if len(kept) == JOINTS:
        columns |= {name: columns[f"tau_{joint}"] for joint, name in enumerate(kept, start=1)}
        mapping = {"torque": {"columns": list(kept), "unit": "N m"}}
    log = read_log(write_parquet(tmp_path / "log.parquet", columns), mapping=mapping)
    assert log.channels == ("position", "torque")
    assert set(log.ignored_columns) == ({"tau_1", "tau_2"} if mapping else set(kept))


UNUSABLE = {
    "text": np.array(["MOVE"] * 3000, dtype=object),
    "empty cells": np.full(3000, np.nan),
    "a few gaps": np.where(np.arange(3000) % 300 == 0, np.nan, 1.0),
    "numbers beyond any": np.full(3000, 1e300),
}


def write_text(path, columns):
    rows = (",".join(map(str, row)) for row in zip(*columns.values(), strict=True))
    path.write_text("\n".join([",".join(columns), *rows]))
    return path


@pytest.mark.parametrize("what", UNUSABLE)
@pytest.mark.parametrize(("name", "write"), [("log.csv", write_text), ("log.parquet", write_parquet)])
def test_references_that_cannot_be_used_refuse_no_log(what, name, write, tmp_path):
    """No computation uses them, and recorders fill such columns with anything."""
    columns = swing(joints=JOINTS) | {f"command_{joint}": UNUSABLE[what] for joint in (1, 2)}
    path = write(tmp_path / name, columns)
    log = read_log(str(path))
    assert log.channels == ("position", "torque")
    assert set(log.ignored_columns) == {"command_1", "command_2"}
    check = check_log(path)
    assert check.refusal is None
    assert [bound.name for bound in check.recognised] == [TIME, "position", "torque"]
    assert [reach.channel for reach in check.reach] == ["position", "torque"]


def test_a_reference_that_the_mapping_names_has_to_be_usable(tmp_path):
    columns = swing(joints=JOINTS) | {f"target_{joint}": np.full(3000, np.nan) for joint in (1, 2)}
    path = write_csv(tmp_path / "log.csv", columns)
    mapping = {"position_ref": {"columns": ["target_1", "target_2"], "unit": "rad"}}
    with pytest.raises(LogError):
        read_log(path, mapping=mapping)


def test_what_was_measured_is_suggested_before_what_was_asked_for(tmp_path):
    columns = swing(joints=JOINTS)
    renamed = {"time": columns["time"]}
    for joint in (1, 2):
        renamed |= {f"q_des{joint}": columns[f"q_{joint}"], f"pos{joint}": columns[f"q_{joint}"]}
        renamed |= {f"trq{joint}": columns[f"tau_{joint}"], f"cmd{joint}": columns[f"tau_{joint}"]}
    suggestion = check_log(write_csv(tmp_path / "log.csv", renamed)).suggestion
    assert {name: entry["columns"] for name, entry in suggestion.items() if name != TIME} == {
        "position": ["pos1", "pos2"],
        "torque": ["trq1", "trq2"],
        "position_ref": ["q_des1", "q_des2"],
        "command": ["cmd1", "cmd2"],
    }
    alone = {name: values for name, values in renamed.items() if not name.startswith(("pos", "cmd"))}
    suggestion = check_log(write_csv(tmp_path / "log.csv", alone)).suggestion
    assert suggestion["position"]["columns"] == ["q_des1", "q_des2"]


def test_an_identification_is_equal_to_the_bit_with_and_without_references():
    model = standard_model(planar_robot())
    state = swing_of(2, seed=3)
    rows = whole_rows(log_of(model, true_parameters(model), state, np.zeros_like(state.position)))
    asked = replace(rows, position_ref=rows.position + 1.0, command=rows.position)
    bare, with_reference = (
        identify(
            IdentifyRequest(
                model.robot,
                (log_from_arrays("log", own.time, **own.channels()),),
                {"bootstrap": {"draws": 0}},
            )
        )
        for own in (rows, asked)
    )
    assert json.dumps(bare) == json.dumps(with_reference)
