"""Rows that say nothing are left out and listed; a robot that stands at zero is not among them."""

import numpy as np
import pytest

from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

TIME = np.arange(3000) / 250.0
POSITION = np.column_stack([np.sin(3.0 * TIME + 1.0), 0.5 + np.cos(2.0 * TIME)])
TORQUE = np.column_stack([4.0 * np.cos(3.0 * TIME + 1.0), np.sin(2.0 * TIME)])


def read(tmp_path, time, position, torque):
    rows = np.column_stack([time, position, torque])
    lines = ["t,q_1,q_2,tau_1,tau_2", *(",".join(map(repr, map(float, row))) for row in rows)]
    path = tmp_path / "log.csv"
    path.write_text("\n".join(lines))
    channels = {"position": ("q", "rad"), "torque": ("tau", "N m")}
    mapping = {
        name: {"columns": [f"{symbol}_1", f"{symbol}_2"], "unit": unit}
        for name, (symbol, unit) in channels.items()
    }
    return read_log(path, mapping={"time": {"column": "t", "unit": "s"}, **mapping})


def test_a_row_that_is_written_twice_is_left_out(tmp_path):
    twice = np.sort(np.r_[np.arange(3000), [7, 500, 500, 2999]])
    log = read(tmp_path, TIME[twice], POSITION[twice], TORQUE[twice])
    assert np.array_equal(whole_rows(log).position, POSITION)
    (defect,) = log.defects
    assert (defect.kind, defect.count) == ("doubled_rows", 4)


@pytest.mark.parametrize("rows", [1, 3, 7])
def test_zeros_of_a_lost_packet_are_left_out(tmp_path, rows):
    position, torque = POSITION.copy(), TORQUE.copy()
    for first in (900, 1500):
        position[first : first + rows] = torque[first : first + rows] = 0.0
    log = read(tmp_path, TIME, position, torque)
    assert log.samples == 3000 - 2 * rows
    assert {defect.kind: defect.count for defect in log.defects}["blank_rows"] == 2 * rows
    assert "outliers" not in {defect.kind for defect in log.defects}


def test_a_robot_that_passes_or_stands_at_zero_loses_no_row(tmp_path):
    position, torque = POSITION * np.sin(0.8 * TIME)[:, None] ** 4, TORQUE * np.sin(0.8 * TIME)[:, None] ** 4
    still = np.abs(np.sin(0.8 * TIME)) < 0.05
    position[still] = torque[still] = 0.0
    log = read(tmp_path, TIME, position, torque)
    assert log.samples == 3000
    assert "blank_rows" not in {defect.kind for defect in log.defects}


def test_zeros_of_a_lost_packet_are_told_by_the_efforts_where_all_joints_pass_zero(tmp_path):
    """Position and rate are small there; the torque is not."""
    position = np.column_stack([np.sin(2.0 * np.pi * TIME), np.sin(4.0 * np.pi * TIME)])
    torque = TORQUE + 20.0
    position[1000:1003] = torque[1000:1003] = 0.0
    assert np.all(np.abs(position[[999, 1003]]) < 0.2)
    log = read(tmp_path, TIME, position, torque)
    assert {defect.kind: defect.count for defect in log.defects}["blank_rows"] == 3
    assert "repeated_rows" not in {defect.kind for defect in log.defects}


def test_a_lost_packet_is_told_whatever_its_zeros_have_become(tmp_path):
    """Offsets and factors of a set-up turn them into any other row."""
    position, torque = POSITION.copy(), TORQUE.copy()
    for first in (900, 1500):
        position[first : first + 3], torque[first : first + 3] = (0.0, -np.pi), (0.0, 4.0)
    log = read(tmp_path, TIME, position, torque)
    assert {defect.kind: defect.count for defect in log.defects}["blank_rows"] == 6


def test_two_lost_packets_of_different_rows_in_a_row_are_both_left_out(tmp_path):
    position, torque = POSITION.copy(), TORQUE.copy()
    position[900:903], torque[900:903] = (0.0, -np.pi), (0.0, 4.0)
    position[903:906], torque[903:906] = (9.0, 0.0), (0.0, -4.0)
    log = read(tmp_path, TIME, position, torque)
    assert {defect.kind: defect.count for defect in log.defects}["blank_rows"] == 6


def test_rows_that_a_recorder_held_are_no_lost_packet(tmp_path):
    position, torque = POSITION.copy(), TORQUE.copy()
    position[900:915], torque[900:915] = position[900], torque[900]
    log = read(tmp_path, TIME, position, torque)
    assert log.samples == 3000
    assert {defect.kind for defect in log.defects} == {"repeated_rows"}


NOISE = 0.02 * np.random.default_rng(3).normal(size=TORQUE.shape)


@pytest.mark.parametrize("value", [0.0, 20.0])
@pytest.mark.parametrize("rows", [3, 20])
def test_a_drive_that_does_not_answer_for_a_moment_is_left_out(tmp_path, rows, value):
    """Whatever the channel holds meanwhile; the other channels go on."""
    torque, far = TORQUE + NOISE, np.abs(TORQUE[:, 0] - value) > 1.0
    lost = [first for first in range(400, 2900, 250) if far[first - 1 : first + rows + 1].all()]
    for first in lost:
        torque[first : first + rows, 0] = value
    log = read(tmp_path, TIME, POSITION, torque)
    counts = {defect.kind: defect.count for defect in log.defects}
    assert len(lost) > 5
    assert counts["lost_values"] == len(lost) * rows == 3000 - log.samples


def test_a_position_that_is_lost_for_a_moment_is_left_out_and_does_not_refuse_the_log(tmp_path):
    position = POSITION.copy()
    position[900:904, 1] = 0.0
    log = read(tmp_path, TIME, position, TORQUE + NOISE)
    assert {defect.kind: defect.count for defect in log.defects}["lost_values"] == 4


@pytest.mark.parametrize("rows", [1, 2, 6])
def test_zeros_in_a_coarse_log_are_left_out_however_small_their_leaps_are(tmp_path, rows):
    """Between samples of a slow bus a torque steps as far as a zero lies from it."""
    time, position, torque = (series[::10] for series in (TIME, POSITION, TORQUE + NOISE))
    torque = torque + np.array([1.0, 0.0])
    lost = range(20, 280, 20)
    for first in lost:
        torque[first : first + rows] = 0.0
    log = read(tmp_path, time, position, torque)
    assert {defect.kind: defect.count for defect in log.defects}["lost_values"] == len(lost) * rows


@pytest.mark.parametrize("every", [2, 3, 4])
@pytest.mark.parametrize("joints", [[0], [0, 1]])
def test_zeros_between_the_samples_of_a_slower_channel_are_left_out(tmp_path, every, joints):
    """A filter makes a half, or a third, of the torque of them, which no fit shows."""
    torque = TORQUE + NOISE + np.array([0.0, 3.0])
    filled = np.arange(3000) % every != 0
    torque[np.ix_(filled, joints)] = 0.0
    log = read(tmp_path, TIME, POSITION, torque)
    assert abs(log.samples - np.count_nonzero(~filled)) <= every
    assert "lost_values" in {defect.kind for defect in log.defects}


def test_zeros_that_a_channel_passes_or_rests_at_are_its_own(tmp_path):
    """Of a coarse friction torque, and of a current that is not reported below its dead zone."""
    coarse = np.round(4.0 * np.tanh(40.0 * TORQUE[:, 0]) + NOISE[:, 0])
    silent = np.where(np.abs(TORQUE[:, 1]) < 0.3, 0.0, TORQUE[:, 1] + NOISE[:, 1])
    log = read(tmp_path, TIME, POSITION, np.column_stack([coarse, silent]))
    assert log.samples == 3000
    assert "lost_values" not in {defect.kind for defect in log.defects}


@pytest.mark.parametrize("held", [2, 4, 10])
def test_a_torque_that_is_sampled_more_slowly_than_the_positions_loses_no_row(tmp_path, held):
    torque = np.repeat((TORQUE + NOISE)[::held], held, axis=0)[:3000] + 3.0 * np.sign(TORQUE)
    log = read(tmp_path, TIME, POSITION, torque)
    assert log.samples == 3000
    assert "lost_values" not in {defect.kind for defect in log.defects}


def test_torque_pulses_of_a_simulation_without_noise_lose_no_row(tmp_path):
    """A pulse test and a binary excitation hold one value each time, and leap."""
    pulses, binary = np.zeros(3000), np.sign(np.sin(0.11 * np.arange(3000) ** 1.05))
    pulses[1000:1010] = pulses[2000:2012] = 5.0
    log = read(tmp_path, TIME, POSITION, np.column_stack([pulses, binary]))
    assert log.samples == 3000
    assert "lost_values" not in {defect.kind for defect in log.defects}
