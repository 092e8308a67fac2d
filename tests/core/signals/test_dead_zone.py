"""A torque channel with a dead zone is restored where it reads something, and marked where it reads zero."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from tests.core.estimate.worlds import planar_robot
from veritorque.core.log.model import JointLog, joined_rows, whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.signals.dead_zone import DeadZone, unread, with_restored_torque

HALF, RATE_HZ = 0.6, 250.0
TIME = 50.0 + np.arange(2000) / RATE_HZ
TORQUE = np.column_stack([3.0 * np.sin(2.0 * TIME), 2.0 * np.cos(3.1 * TIME)])
MOTION = np.sin(TIME[:, None] * [0.7, 0.9])
LAWS = {
    True: lambda torque: np.sign(torque) * np.maximum(np.abs(torque) - HALF, 0.0),
    False: lambda torque: np.where(np.abs(torque) < HALF, 0.0, torque),
}
each_law = pytest.mark.parametrize("shrinks", LAWS, ids=["shrinks", "passes"])


def zone(*, shrinks: bool) -> DeadZone:
    return DeadZone(0, 1, HALF, 0.01, HALF if shrinks else 0.0, zeros=100, share=0.1, p_value=0.0)


def read_torque(*, shrinks: bool) -> np.ndarray:
    return np.column_stack([TORQUE[:, 0], LAWS[shrinks](TORQUE[:, 1])])


def log_of(torque: np.ndarray) -> JointLog:
    return log_from_arrays("dead", TIME, MOTION, torque)


@each_law
def test_what_is_read_becomes_the_torque_that_acted_and_zeros_join_it(shrinks):
    log = log_of(read_torque(shrinks=shrinks))
    found = whole_rows(with_restored_torque(log, planar_robot(), [zone(shrinks=shrinks)])).torque
    read = np.abs(TORQUE[:, 1]) > HALF
    np.testing.assert_allclose(found[read], TORQUE[read], rtol=1e-12)
    np.testing.assert_array_equal(found[:, 0], TORQUE[:, 0])
    assert np.abs(found - TORQUE).max() < 0.05 * HALF


def test_pieces_of_a_log_are_restored_alike():
    whole = with_restored_torque(log_of(read_torque(shrinks=True)), planar_robot(), [zone(shrinks=True)])
    away = [row for row in range(0, 2000, 100) if abs(TORQUE[row, 1]) > HALF]
    pieces = [whole.source.rows(start, stop) for start, stop in pairwise(away)]
    joined = joined_rows(pieces)
    np.testing.assert_array_equal(joined.torque, whole.source.rows(away[0], away[-1]).torque)


def test_a_current_is_restored_by_the_torque_that_it_lacks():
    constant, ratio = 0.2, 50.0
    robot = planar_robot()
    joints = tuple(replace(one, torque_constant=constant, gear_ratio=ratio) for one in robot.joints)
    read = read_torque(shrinks=True) / (constant * ratio)
    log = log_from_arrays("currents", TIME, MOTION, None, current=read)
    rows = whole_rows(with_restored_torque(log, replace(robot, joints=joints), [zone(shrinks=True)]))
    acts = np.abs(TORQUE[:, 1]) > HALF
    np.testing.assert_allclose(constant * ratio * rows.current[acts], TORQUE[acts], rtol=1e-12)
    assert rows.torque is None


def test_a_log_without_zones_is_the_same():
    log = log_of(TORQUE)
    assert with_restored_torque(log, planar_robot(), []) is log


@each_law
def test_only_instants_beside_a_zero_of_the_channel_are_not_read(shrinks):
    marks = unread(log_of(read_torque(shrinks=shrinks)), [zone(shrinks=shrinks)], TIME, 0.02)
    zeros = TIME[np.abs(TORQUE[:, 1]) <= HALF]
    near = np.abs(TIME[:, None] - zeros).min(axis=1)
    assert not marks[:, 0].any()
    assert marks[near < 0.019, 1].all()
    assert not marks[near > 0.021, 1].any()
