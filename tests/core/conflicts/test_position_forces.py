"""Hold corrections to forces that follow positions: a spring that nobody described is no wrong set-up."""

from dataclasses import replace

import numpy as np
import pytest

from tests.conflicts.score import PLAIN
from tests.plant.cases import draw_clean
from veritorque.core.conflicts.setup import Setup
from veritorque.core.log.columns.assignment import Assignment
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.study import IdentifyRequest, identify


def named(seed, robot, *, reversed_joint=None):
    """Name the conflicts of a sound arm with a strong spring between its first link and its tip."""
    case = draw_clean(seed, noise="white", robot=robot, duration=15.0)
    rows = whole_rows(case.log)
    torque, bend = rows.torque.copy(), rows.position[:, 0] + rows.position[:, 1]
    stretch = (bend - bend.mean()) / bend.std()
    torque[:, :2] += 2.0 * np.sqrt(np.mean(torque[:, :2] ** 2)) * stretch[:, None]
    if reversed_joint is not None:
        torque[:, reversed_joint - 1] *= -1.0
    log = log_from_arrays("log", rows.time, rows.position, torque)
    document = identify(IdentifyRequest(case.believed, (log,), PLAIN))
    return [(row["conflict"], *row["joints"]) for row in document["conflicts"] if row["confidence"] > 0.5]


@pytest.mark.parametrize(("seed", "robot"), [(4002, "planar-2"), (4007, "planar-2"), (4010, "planar-3")])
def test_a_strong_spring_is_no_wrong_table(seed, robot):
    assert named(seed, robot) == []


def test_a_correction_is_unsure_where_such_a_force_does_as_well_with_it_as_without():
    assert named(4005, "planar-2") == []


@pytest.mark.parametrize(("seed", "robot"), [(4003, "planar-2"), (4007, "planar-2"), (4008, "planar-3")])
def test_a_reversed_torque_is_named_beside_a_spring_and_no_wrong_table(seed, robot):
    joint = int(robot[-1])
    assert named(seed, robot, reversed_joint=joint) == [("torque_sign", joint)]


def test_no_motors_ratios_are_named_beside_exchanged_channels_in_the_place_of_a_spring():
    assert named(4008, "planar-2", reversed_joint=2) == []


def test_a_set_up_takes_parts_of_another(arm):
    plain = Setup(arm, Assignment.as_measured(len(arm.joints)))
    other = plain.with_gravity(np.array([9.81, 0.0, 0.0]))
    channels = Assignment.as_measured(len(arm.joints)).torque.exchanged(0, 1)
    other = other.with_torque(channels).with_position(channels.scaled(-1.0, 0))
    parts = frozenset({("gravity", 0), ("torque", 0), ("torque", 1), ("position", 0), ("position", 1)})
    assert other.differing(plain) == parts
    assert not plain.taking(parts, other).differing(other)
    some = plain.taking(frozenset({("torque", 0), ("torque", 1)}), other)
    assert some.differing(plain) == frozenset({("torque", 0), ("torque", 1)})
    assert some.assignment == replace(plain.assignment, torque=channels)


@pytest.fixture
def arm():
    """Give a robot of two joints."""
    return draw_clean(4001, noise="none", robot="planar-2", duration=6.0).believed
