"""Rotations and modified DH rows, held against another library and products of elementary matrices."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from veritorque.core.robot.frames import cross_matrix, rotation_rpy, rotation_to
from veritorque.core.robot.modified_dh import ModifiedDHRow, row_of_placement

ANGLES = st.one_of(st.sampled_from([0.0, np.pi / 2, -np.pi / 2, np.pi, -np.pi]), st.floats(-7.0, 7.0))
LENGTHS = st.one_of(st.just(0.0), st.floats(-2.0, 2.0))
ROWS = st.builds(ModifiedDHRow, alpha=ANGLES, d=LENGTHS, r=LENGTHS, theta=ANGLES, gamma=ANGLES, b=LENGTHS)
EXACT = 1e-13  # a dozen products of numbers of size one


@given(ANGLES, ANGLES, ANGLES)
def test_roll_pitch_yaw_means_what_other_urdf_readers_mean(roll, pitch, yaw):
    np.testing.assert_allclose(
        rotation_rpy(roll, pitch, yaw), pin.rpy.rpyToMatrix(roll, pitch, yaw), atol=EXACT
    )


@given(st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda axis: np.linalg.norm(axis) > 1e-3))
@example((0.0, 0.0, 1.0))
@example((0.0, 0.0, -1.0))
@example((1e-6, 0.0, -1.0))
@example((3e-9, -1e-9, -1.0))
@example((1e-160, 0.0, -1.0))
def test_the_frame_turned_to_an_axis_is_a_rotation_with_that_axis_as_z(axis):
    unit = np.array(axis) / np.linalg.norm(axis)
    rotation = rotation_to(unit)
    np.testing.assert_allclose(rotation[:, 2], unit, atol=1e-15)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=EXACT)
    assert np.linalg.det(rotation) == pytest.approx(1.0)


def test_the_frame_turned_to_z_is_left_alone():
    assert np.array_equal(rotation_to(np.array([0.0, 0.0, 1.0])), np.eye(3))


@given(st.tuples(*[st.floats(-9.0, 9.0)] * 6))
def test_the_cross_matrix_gives_the_cross_product(numbers):
    one, other = np.array(numbers[:3]), np.array(numbers[3:])
    np.testing.assert_allclose(cross_matrix(one) @ other, np.cross(one, other), atol=1e-13)


@given(ROWS)
def test_a_modified_dh_row_is_the_product_of_its_six_steps(row):
    steps = _turn(2, row.gamma) @ _shift(2, row.b) @ _turn(0, row.alpha) @ _shift(0, row.d)
    expected = steps @ _turn(2, row.theta) @ _shift(2, row.r)
    rotation, translation = row.placement()
    np.testing.assert_allclose(rotation, expected[:3, :3], atol=EXACT)
    np.testing.assert_allclose(translation, expected[:3, 3], atol=EXACT)


@given(ANGLES, ANGLES, ANGLES, LENGTHS, LENGTHS, LENGTHS)
@example(0.0, 0.0, 0.0, 0.1, 0.2, 0.3)
@example(np.pi, 0.0, 0.4, 0.1, 0.2, 0.3)
@example(1e-12, 0.0, 0.0, 0.1, 0.2, 0.3)
def test_every_placement_can_be_written_as_a_modified_dh_row(roll, pitch, yaw, x, y, z):
    rotation, translation = rotation_rpy(roll, pitch, yaw), np.array([x, y, z])
    row = row_of_placement(rotation, translation)
    # Where the two z axes are nearly parallel, r and b are long and cancel: fewer digits are left.
    reach = 1.0 + abs(row.r) + abs(row.b)
    np.testing.assert_allclose(row.placement()[0], rotation, atol=3e-9)
    np.testing.assert_allclose(row.placement()[1], translation, atol=3e-9 + 1e-14 * reach)


def _turn(axis: int, angle: float) -> np.ndarray:
    step = np.eye(4)
    one, other = (axis + 1) % 3, (axis + 2) % 3
    step[one, one] = step[other, other] = np.cos(angle)
    step[other, one], step[one, other] = np.sin(angle), -np.sin(angle)
    return step


def _shift(axis: int, length: float) -> np.ndarray:
    step = np.eye(4)
    step[axis, 3] = length
    return step


@given(ROWS, st.floats(-3.0, 3.0))
def test_a_joint_coordinate_adds_to_theta_or_to_r_of_its_row(row, coordinate):
    turned, slid = replace(row, theta=row.theta + coordinate), replace(row, r=row.r + coordinate)
    rotation, translation = row.placement()
    for moved, motion in ((turned, _turn(2, coordinate)), (slid, _shift(2, coordinate))):
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = rotation, translation
        expected = pose @ motion
        np.testing.assert_allclose(moved.placement()[0], expected[:3, :3], atol=EXACT)
        np.testing.assert_allclose(moved.placement()[1], expected[:3, 3], atol=EXACT)
