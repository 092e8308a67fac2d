"""Say how large links are: by their shapes, by the axes that they carry, or not at all."""

import json
from dataclasses import replace

import numpy as np
import pytest

from tests.measured import measured_robot
from tests.tools import random_robot
from veritorque.core.robot.builtin import builtin_robot
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.extent import distance_square, link_extents, mean_distance
from veritorque.core.robot.inertia import from_mass_properties, pseudo_inertia
from veritorque.core.robot.model import Ball
from veritorque.core.robot.urdf.read import robot_from_urdf
from veritorque.core.robot.writing import to_description

MESH = '<mesh filename="a.stl"/>'
BOX = '<box size="0.6 0.2 0.3"/>'
ROD = '<cylinder radius="0.03" length="0.08"/>'


def urdf(collision="", visual="", flange=""):
    """Write an arm of two links of 0.4 m; the first has the shapes given, the flange is welded to it."""

    def shape(kind, geometry):
        place = '<origin xyz="0.2 0 0" rpy="0 0 0"/>'
        return f"<{kind}>{place}<geometry>{geometry}</geometry></{kind}>" if geometry else ""

    inertial = (
        '<inertial><origin xyz="0.2 0 0"/><mass value="2"/>'
        '<inertia ixx="0.01" iyy="0.03" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    return f"""<robot name="arm"><link name="base"/>
    <link name="upper">{inertial}{shape("collision", collision)}{shape("visual", visual)}</link>
    <link name="fore">{inertial}</link>
    <link name="flange">{shape("collision", flange)}</link>
    <joint name="a" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
      <limit effort="1" velocity="1" lower="-1" upper="1"/></joint>
    <joint name="b" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0.4 0 0"/>
      <axis xyz="0 0 1"/><limit effort="1" velocity="1" lower="-1" upper="1"/></joint>
    <joint name="c" type="fixed"><parent link="upper"/><child link="flange"/><origin xyz="0.5 0 0"/></joint>
    </robot>"""


def test_a_box_gives_the_ball_about_it_and_a_welded_link_belongs_to_it():
    (upper, fore) = robot_from_urdf(urdf(BOX)).shapes
    assert upper.centre == pytest.approx((0.2, 0.0, 0.0))
    assert upper.radius == pytest.approx(0.35)  # half of sqrt(0.6^2 + 0.2^2 + 0.3^2)
    assert fore is None
    (both, _) = robot_from_urdf(urdf(BOX, flange='<sphere radius="0.1"/>')).shapes
    for ball in (upper, Ball((0.7, 0.0, 0.0), 0.1)):
        gap = both.radius - np.linalg.norm(np.subtract(both.centre, ball.centre)) - ball.radius
        assert gap >= -1e-12


def test_meshes_are_not_read_and_simple_shapes_of_the_other_kind_are():
    assert robot_from_urdf(urdf(MESH, MESH)).shapes is None
    assert robot_from_urdf(urdf(MESH, BOX)).shapes == robot_from_urdf(urdf(BOX, MESH)).shapes
    assert robot_from_urdf(urdf(ROD)).shapes[0].radius == pytest.approx(0.05)
    assert robot_from_urdf(urdf('<sphere radius="-0.1"/>')).shapes[0].radius == 0.1
    assert robot_from_urdf(urdf('<box size="a lot"/>', BOX)).shapes == robot_from_urdf(urdf(BOX)).shapes


def test_a_shape_that_does_not_reach_the_axis_it_carries_is_not_all_of_the_link():
    (upper, fore) = link_extents(robot_from_urdf(urdf('<sphere radius="0.01"/>')))
    assert (upper.source, fore.source) == ("shapes", "axes")
    for point in (np.zeros(3), np.array([0.4, 0.0, 0.0])):
        assert np.linalg.norm(point - upper.ball.centre) < upper.ball.radius


def test_a_description_holds_the_shapes_of_a_urdf():
    robot = robot_from_urdf(urdf(BOX))
    written = json.loads(json.dumps(to_description(robot)))
    assert robot_from_description(written).shapes == robot.shapes
    assert "shapes" not in to_description(builtin_robot("yumi-left"))


@pytest.mark.parametrize("seed", range(5))
def test_an_assumed_ball_holds_the_axes_that_the_link_carries_and_its_own_joint(seed):
    robot = random_robot(np.random.default_rng(seed), 5)
    for number, extent in enumerate(link_extents(robot), start=1):
        ends = [link.translation for link in robot.links if link.antecedent == number]
        for point in (np.zeros(3), *ends):
            assert np.linalg.norm(point - extent.ball.centre) <= extent.ball.radius


def test_the_balls_of_an_arm_grow_with_it_and_do_not_depend_on_where_it_stands():
    def arm(scale, base):
        row = {"type": "revolute", "alpha": 0.0, "r": 0.0, "theta_offset": 0.0}
        return robot_from_description(
            {"name": "arm", "joints": [{**row, "d": base}, {**row, "d": 2.0 * scale}]}
        )

    small, large, moved = (link_extents(arm(*sizes)) for sizes in ((1.0, 0.0), (2.0, 0.0), (1.0, 9.0)))
    assert [one.ball for one in small] == [one.ball for one in moved]
    for one, two in zip(small, large, strict=True):
        assert 1.5 < two.ball.radius / one.ball.radius < 2.0  # a tenth of a metre stays


def test_measured_arms_get_balls_of_some_decimetres():
    assumed = [one.ball.radius for one in link_extents(measured_robot("franka_panda"))]
    assert 0.3 <= min(assumed) < max(assumed) < 0.6
    shaped = link_extents(measured_robot("ur10e_open"))
    assert {one.source for one in shaped} == {"shapes"}
    assert min(one.ball.radius for one in shaped) >= 0.15
    assert shaped[-1].ball.radius == 0.3  # a tool is in no description


def test_a_body_that_the_description_gives_lies_inside_what_is_assumed():
    robot = builtin_robot("yumi-left")
    far = from_mass_properties(1.0, np.array([0.0, 0.0, 2.0]), 0.1 * np.eye(3))
    for extent in link_extents(replace(robot, prior=np.tile(far, (7, 1)))):
        assert mean_distance(far, extent.ball.centre) <= extent.ball.radius


def test_the_mean_square_distance_is_linear_in_the_parameters():
    rng = np.random.default_rng(3)
    points, masses, centre = rng.normal(size=(6, 3)), rng.uniform(0.1, 1.0, 6), (0.3, -0.2, 0.5)
    bodies = [from_mass_properties(m, x, np.zeros((3, 3))) for m, x in zip(masses, points, strict=True)]
    expected = masses @ ((points - centre) ** 2).sum(axis=1)
    assert np.sum(pseudo_inertia(sum(bodies)) * distance_square(centre)) == pytest.approx(expected)
