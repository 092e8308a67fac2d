"""Hold assignments: each can be undone, and the mapping of an assigned log reads its file the same way."""

from dataclasses import replace

import numpy as np
import pytest

from veritorque.core.log.channels import CHANNELS, UNITS
from veritorque.core.log.columns.assignment import Assignment, assigned, mapping_of
from veritorque.core.log.columns.binding import Binding
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

CHANGES = {
    "sign": lambda one: replace(one, torque=one.torque.scaled(-1.0, 1)),
    "order": lambda one: replace(one, position=one.position.exchanged(0, 2)),
    "zero": lambda one: replace(one, position=one.position.moved(np.pi / 2, 1)),
    "linkage": lambda one: replace(one, position=one.position.with_added(-1.0, 1, 2)),
    "linkage, order, sign and zero": lambda one: replace(
        one, position=one.position.exchanged(0, 1).scaled(-2.0, 0).moved(0.3, 2).with_added(1.0, 0, 2)
    ),
    "all at once": lambda one: Assignment(
        one.position.exchanged(0, 1).scaled(-1.0, 0).moved(0.3, 2), one.torque.scaled(1e-3, 2).exchanged(1, 2)
    ),
}

AS_MEASURED = Assignment.as_measured(3)


@pytest.fixture(params=["SI", "other units", "linked"])
def log(request, tmp_path):
    rng, time = np.random.default_rng(1), np.arange(600) / 100.0
    series = np.sin(np.outer(time, rng.uniform(1.0, 4.0, 9)))
    names = [f"{prefix}_{joint}" for prefix in ("q", "qd", "tau") for joint in (1, 2, 3)]
    mapping = None
    if request.param == "other units":
        series[:, :3] *= 90.0
        mapping = {
            "position": {"columns": names[:3], "unit": "deg", "offset": [0.0, 10.0, 0.0]},
            "torque": {"columns": names[6:], "unit": "N m", "scale": [1.0, -2.0, 1.0]},
        }
    if request.param == "linked":
        linkage = [{"joint": 3, "adds": 2}, {"joint": 2, "adds": 1, "factor": -0.5}]
        shared = {"linkage": linkage, "scale": [1.0, -1.0, 1.0]}
        mapping = {
            "position": {"columns": names[:3], "unit": "rad", "offset": [0.0, 0.2, -0.1], **shared},
            "velocity": {"columns": names[3:6], "unit": "rad/s", **shared},
        }
    path = tmp_path / "log.csv"
    table = np.column_stack([time, series])
    np.savetxt(path, table, fmt="%.17g", delimiter=",", header=",".join(["time", *names]), comments="")
    return path, read_log(path, mapping=mapping)


WRITTEN = {
    ("position", "rad", 1e-3): "mm",
    ("position", "rad", 1.0): "m",
    ("position", "mm", 1e3): "m",
    ("position", "m", -1e-3): "mm",
    ("velocity", "rad/s", 1e-3): "mm/s",
    ("torque", "N m", -1.0): "N",
}


@pytest.mark.parametrize(("channel", "declared", "factor"), WRITTEN)
def test_the_correction_of_a_prismatic_joint_is_written_in_its_units(channel, declared, factor):
    """The other joint is revolute, and stays in the units that were declared for it."""
    unit = CHANNELS[channel].quantity.revolute
    gain = UNITS[channel][declared].factor * factor
    bound = Binding(channel, ("a", "b"), (1.0, gain), (0.0, 0.0), (unit, declared))
    written = bound.as_mapping(prismatic=[2])
    assert written["unit"] == [unit, WRITTEN[channel, declared, factor]]
    assert written.get("scale", [1.0, 1.0]) == [1.0, np.sign(factor)]


@pytest.mark.parametrize("prismatic", [(), (2,), (1, 2, 3)])
@pytest.mark.parametrize("change", sorted(CHANGES))
def test_the_mapping_of_an_assigned_log_reads_its_file_as_the_log_is_whichever_joints_are_prismatic(
    log, change, prismatic
):
    path, read = log
    other = assigned(read, CHANGES[change](Assignment.as_measured(3)))
    again = read_log(path, mapping=mapping_of(other, prismatic))
    for name, values in whole_rows(other).channels().items():
        np.testing.assert_allclose(whole_rows(again).channels()[name], values, rtol=1e-12, atol=1e-12)


def test_a_log_as_measured_is_the_log_itself(log):
    assert assigned(log[1], Assignment.as_measured(3)) is log[1]


def test_linked_positions_are_sums_of_those_that_were_read(log):
    read = log[1]
    linked = assigned(read, CHANGES["linkage"](Assignment.as_measured(3)))
    before, after = whole_rows(read), whole_rows(linked)
    for name in ("position", "velocity"):
        own, whole = before.channels()[name], after.channels()[name]
        np.testing.assert_allclose(whole[:, 2], own[:, 2] - own[:, 1])
        np.testing.assert_array_equal(whole[:, :2], own[:, :2])
    np.testing.assert_array_equal(after.torque, before.torque)
    back = assigned(linked, replace(AS_MEASURED, position=AS_MEASURED.position.with_added(1.0, 1, 2)))
    np.testing.assert_allclose(whole_rows(back).position, before.position, atol=1e-12)


def test_what_is_exchanged_twice_is_as_it_was(log):
    plain = Assignment.as_measured(3)
    assert plain.position.exchanged(0, 2).exchanged(0, 2) == plain.position
    assert plain.torque.scaled(-1.0, 0, 2).scaled(-1.0, 0, 2) == plain.torque


def test_stamps_that_are_corrected_change_the_rate_and_leave_the_samples(log):
    read = log[1]
    slower = assigned(read, replace(Assignment.as_measured(3), time_factor=0.5))
    assert slower.rate_hz == pytest.approx(2.0 * read.rate_hz)
    assert slower.duration == pytest.approx(0.5 * read.duration)
    np.testing.assert_array_equal(whole_rows(slower).position, whole_rows(read).position)
