"""Say where the mass of each link can be: a ball in the link's frame.

Best is what the user declares (option `bounds.size`); next the boxes, cylinders and spheres of a URDF.
Without either a link is assumed to lie about its joint's axis and the axes it carries. Frames sit anywhere on
their axes, so the feet of the common normals count too. Source: Wensing, Kim & Slotine 2018, section IV.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ..arrays import LinkParameters, Vector3
from .inertia import pseudo_inertia
from .model import Ball, Link, RobotModel

BODY, SHARE_OF_REACH = 0.1, 0.1
"""What a body reaches beyond the axes it carries: m, plus a share of the sum of all distances between axes.
Drives and covers of arms of 0.5 to 3 m reach 0.1 to 0.3 m beyond; halved, the ball cuts such covers off."""
LEAST_ASSUMED = 0.3
"""Least radius of an assumed ball, m: a tool or a counterweight at an axis without any distance. Tools are in
few descriptions, so a link without a successor has at least this one with shapes, too."""
TIP = 0.5
"""Share of the longest link that a link without a successor is long: its tool is in no table."""
GEOMETRY = 0.05
"""What a body reaches beyond the shapes of its URDF, m; shapes for collisions are simplified."""
Source = Literal["declared", "shapes", "axes"]


@dataclass(frozen=True)
class Extent:
    """Hold the ball in which a link's mass lies, and where it is known from."""

    ball: Ball
    source: Source


def link_extents(robot: RobotModel) -> tuple[Extent | None, ...]:
    """Give each link's extent without a declaration; None where nothing says how large a link is.

    Examples
    --------
    Nothing says how long a pendulum is:

    >>> from .model import Joint
    >>> link = Link("bar", "revolute", 0, 1, np.eye(3), np.zeros(3))
    >>> link_extents(RobotModel("pendulum", (link,), (Joint("pivot"),), np.zeros(3)))
    (None,)
    """
    carriers = {link.antecedent for link in robot.links}
    distances = [_distance(robot, link) for link in robot.links if link.antecedent]
    longest, reach = max(distances, default=0.0), sum(distances)
    margin = BODY + SHARE_OF_REACH * reach
    found: list[Extent | None] = []
    for index in range(len(robot.links)):
        points = _axis_points(robot, index)
        is_tip = index + 1 not in carriers
        shape = None if robot.shapes is None else robot.shapes[index]
        if shape is not None:
            found.append(_of_shape(shape, points, is_tip=is_tip))
        elif longest == 0.0:
            found.append(None)
        else:
            ball = _grown(Ball.around(points), margin + TIP * longest * is_tip, LEAST_ASSUMED)
            found.append(Extent(_with_prior(ball, robot, index), "axes"))
    return tuple(found)


def _of_shape(shape: Ball, points: Sequence[np.ndarray], *, is_tip: bool) -> Extent:
    """Give the extent of a link whose shape is described."""
    whole = Ball.joined((shape, Ball.around(points)))
    return Extent(_grown(whole, GEOMETRY, LEAST_ASSUMED if is_tip else 2.0 * GEOMETRY), "shapes")


def _grown(ball: Ball, margin: float, least: float) -> Ball:
    return replace(ball, radius=max(ball.radius + margin, least))


def _distance(robot: RobotModel, link: Link) -> float:
    """Give how far a link's frame can be from its antecedent's, m."""
    ends = (link.translation + stroke * link.rotation[:, 2] for stroke in _strokes(robot, link))
    return max(float(np.linalg.norm(end)) for end in ends)


def _strokes(robot: RobotModel, link: Link) -> tuple[float, float]:
    """Give how far a link slides along its axis at both ends, m; zeros where it turns."""
    if link.kind == "revolute":
        return 0.0, 0.0
    ends = robot.lower_positions[link.joint - 1], robot.upper_positions[link.joint - 1]
    low, high = (link.ratio * float(end) + link.offset for end in ends)
    return low, high


def _axis_points(robot: RobotModel, index: int) -> list[Vector3]:
    """List points of a link's own axis and of the axes it carries, in its frame."""
    link = robot.links[index]
    points = [np.zeros(3)]
    if link.antecedent:
        height = -float(link.rotation[:, 2] @ link.translation)
        points += [np.array([0.0, 0.0, height - stroke]) for stroke in _strokes(robot, link)]
    for carried in robot.links:
        if carried.antecedent == index + 1:
            axis = carried.rotation[:, 2]
            foot = carried.translation - axis * float(axis @ carried.translation)
            points += [foot, *(carried.translation + stroke * axis for stroke in _strokes(robot, carried))]
    return points


def _with_prior(ball: Ball, robot: RobotModel, index: int) -> Ball:
    """Let an assumed ball hold the body that the robot's own description gives the link."""
    if robot.prior is None:
        return ball
    return replace(ball, radius=max(ball.radius, mean_distance(robot.prior[index], ball.centre)))


def mean_distance(body: LinkParameters, centre: tuple[float, float, float]) -> float:
    """Give the root mean square distance of a body's mass from a point, m; 0 where it has no mass.

    Examples
    --------
    A kilogram at x = 0.3 m:

    >>> mean_distance(np.array([0, 0, 0, 0.09, 0, 0.09, 0.3, 0, 0, 1.0]), (0.0, 0.0, 0.0))
    0.3
    """
    mass = float(body[9])
    if mass <= 0.0:
        return 0.0
    square = float(np.sum(pseudo_inertia(body) * distance_square(centre))) / mass
    return float(np.sqrt(max(square, 0.0)))


def distance_square(centre: tuple[float, float, float]) -> np.ndarray:
    """Give E for which tr(J E) sums mass times squared distance from a point, J a pseudo-inertia."""
    point = np.array(centre)
    return np.block([[np.eye(3), -point[:, None]], [-point[None, :], point @ point]])
