"""A payload is the same body in every frame and in every controller's words."""

import re
from dataclasses import replace

import numpy as np
import pytest

from tests.tools import random_bodies
from veritorque.app.schemas.diagnosis import Payload
from veritorque.core.document.controller_loads import CONTROLLERS, Load
from veritorque.core.document.numbers import plain
from veritorque.core.document.payload import framed_payload, load_in
from veritorque.core.robot.frames import rotation_rpy, rotation_x, rotation_y, rotation_z
from veritorque.core.robot.inertia import from_mass_properties, transform_body
from veritorque.core.robot.model import NamedFrame
from veritorque.core.robot.urdf.read import robot_from_urdf

NUMBER = r"-?\d+(?:\.\d+)?"
HOME = np.eye(3)
URDF = """<robot name="arm"><link name="base"/><link name="wrist"/><link name="tool0"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="wrist"/><axis xyz="0 1 0"/></joint>
  <joint name="end" type="fixed"><parent link="wrist"/><child link="tool0"/>
    <origin xyz="0 0.1 0" rpy="-1.5707963267948966 0 0"/></joint></robot>"""


def numbers(text):
    """Give the numbers of the last lines, without the remark."""
    return [float(word) for word in re.findall(NUMBER, text.split("\n", 1)[1])]


def of_quaternion(w, x, y, z):
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + 2.0 * w * cross + 2.0 * cross @ cross


def read_ur(text):
    mass, x, y, z, ixx, iyy, izz, ixy, ixz, iyz = numbers(text)
    return mass, [x, y, z], np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])


def read_abb(text):
    mass, x, y, z, *rest = numbers(text)
    axes = of_quaternion(*rest[:4])
    return mass, np.array([x, y, z]) / 1e3, axes @ np.diag(rest[4:]) @ axes.T


def read_kuka(text):
    _, mass, x, y, z, a, b, c, *moments = numbers(text)
    turns = zip((rotation_z, rotation_y, rotation_x), np.radians([a, b, c]), strict=True)
    axes = np.linalg.multi_dot([turn(angle) for turn, angle in turns])
    return mass, np.array([x, y, z]) / 1e3, axes @ np.diag(moments) @ axes.T


def read_staubli(text):
    mass, x, y, z, xx, xy, xz, yy, yz, zz = numbers(text)
    return mass, np.array([x, y, z]) / 1e3, np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


READERS = {"ur": read_ur, "abb": read_abb, "kuka": read_kuka, "staubli": read_staubli}
TURNS = [(0.0, 0.0, 0.0), (np.pi, 0.0, 0.0), (0.0, np.pi / 2, 0.0), (0.3, -1.2, 2.8), (np.pi, 0.0, np.pi / 2)]


@pytest.mark.parametrize("controller", sorted(CONTROLLERS))
@pytest.mark.parametrize("turn", TURNS)
def test_what_is_pasted_is_the_same_body_again(controller, turn):
    frame = NamedFrame("flange", 1, rotation_rpy(*turn), np.array([0.02, -0.3, 0.1]))
    for body in random_bodies(np.random.default_rng(5), 5):
        text = CONTROLLERS[controller](load_in(body, frame), frame.name)
        mass, centre, inertia = READERS[controller](text)
        again = from_mass_properties(mass, np.asarray(centre), inertia)
        back = transform_body(again, frame.rotation, frame.translation)
        assert back == pytest.approx(body, abs=2e-7)
        assert "e-" not in text


@pytest.mark.parametrize("controller", sorted(CONTROLLERS))
def test_a_point_mass_has_no_inertia_and_no_turn(controller):
    load = Load(1.5, np.array([0.0, 0.0, 0.05]), np.zeros((3, 3)))
    mass, centre, inertia = READERS[controller](CONTROLLERS[controller](load, "tool0"))
    assert (mass, inertia.any()) == (1.5, False)
    assert centre == pytest.approx(load.centre)


def test_a_payload_is_given_in_the_urdfs_own_frame_and_pasted_in_the_flanges():
    robot = robot_from_urdf(URDF)
    own = from_mass_properties(
        2.0, np.array([0.0, 0.25, 0.0]), np.diag([0.02, 0.01, 0.03])
    )  # as the URDF has it
    frames = {frame.name: frame for frame in robot.frames}
    assert set(frames) == {"wrist", "tool0"}
    body = transform_body(own, frames["wrist"].rotation, frames["wrist"].translation)
    for sign in (1.0, -1.0):
        row = framed_payload(robot, 1, sign * body, 1e-8 * np.eye(10))
        Payload.model_validate({key: plain(value) for key, value in row.items()})
        by_name = {one["frame"]: one for one in row["frames"]}
        assert (row["removed"], row["flange"], row["inertia_known"]) == (sign < 0.0, "tool0", True)
        assert by_name["wrist"]["center_of_mass"] == pytest.approx([0.0, 0.25, 0.0], abs=1e-6)
        assert by_name["tool0"]["center_of_mass"] == pytest.approx([0.0, 0.0, 0.15], abs=1e-6)
        assert set(by_name["tool0"]["paste"]) == set(CONTROLLERS)
        assert by_name["wrist"]["paste"] == {}


def test_without_a_named_flange_nothing_is_pasted_and_an_unknown_inertia_is_a_point():
    robot = replace(robot_from_urdf(URDF), frames=())
    body = from_mass_properties(2.0, np.array([0.0, 0.0, 0.2]), 0.01 * HOME)
    row = framed_payload(robot, 1, body, np.diag([1.0] * 6 + [1e-6] * 4))
    assert (row["flange"], row["inertia_known"]) == (None, False)
    assert [one["paste"] for one in row["frames"]] == [{}]
    assert not np.any(row["frames"][0]["inertia_at_com"])
