"""Make identified robots of every shape that a file has to hold."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from tests.core.robot.urdf.makers import random_urdf
from tests.tools import random_bodies, random_robot, with_mimics
from veritorque.core.document.model.identified import BaseValue, IdentifiedRobot
from veritorque.core.dynamics.model import standard_model
from veritorque.core.robot.builtin import builtin_robot
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import Coupling, Link, RobotModel
from veritorque.core.robot.urdf.read import robot_from_urdf
from veritorque.core.signals.state import MotionState

GUIDE = (Path(__file__).parents[3] / "docs" / "robots.md").read_text(encoding="utf-8")


def _tx40() -> RobotModel:
    texts = re.findall(r"^```json\n(.*?)^```$", GUIDE, re.DOTALL | re.MULTILINE)
    return robot_from_description(json.loads(next(text for text in texts if "Staubli" in text)))


def _backwards() -> RobotModel:
    """Give a robot whose joints count against their axes, with offsets: as a repaired URDF may."""
    plain = random_robot(np.random.default_rng(4), 5)
    links = tuple(
        replace(link, ratio=-1.0 if number % 2 else 1.0, offset=0.1 * number)
        for number, link in enumerate(plain.links)
    )
    return replace(plain, links=links)


def _mimicking() -> RobotModel:
    rng = np.random.default_rng(8)
    return with_mimics(random_robot(rng, 9, tree=True), rng)


def _two_motors() -> RobotModel:
    plain = random_robot(np.random.default_rng(9), 4, prismatic=0.0)
    couplings = (
        Coupling("wrist", 4, (3, 4), (1.0, -0.5)),
        Coupling("shoulder", 9, (1, 2, 3), (1.0, 2.0, 0.3)),
    )
    joints = tuple(
        replace(joint, rotor_inertia=number != 2, friction=("viscous",) if number == 1 else joint.friction)
        for number, joint in enumerate(plain.joints, start=1)
    )
    return replace(plain, joints=joints, couplings=couplings)


ROBOTS: dict[str, RobotModel] = {
    "yumi-left": builtin_robot("yumi-left"),
    "two arms on a body": builtin_robot("yumi"),
    "a tree with slides": random_robot(np.random.default_rng(3), 9, tree=True, prismatic=0.4),
    "a coupled wrist": _tx40(),
    "two coupled motors": _two_motors(),
    "from a urdf": robot_from_urdf(random_urdf(np.random.default_rng(12), 10)),
    "with mimics": _mimicking(),
    "against its axes": _backwards(),
    "hanging": replace(_tx40(), gravity=np.array([0.0, 0.0, 9.81])),
    "in free fall": random_robot(np.random.default_rng(6), 3, gravity=False),
}


def identified(robot: RobotModel, seed: int = 0) -> IdentifiedRobot:
    """Give a robot physically consistent bodies and drives with every number set."""
    rng = np.random.default_rng(seed)
    model = standard_model(robot)
    standard = rng.uniform(0.05, 0.5, len(model.parameters))
    standard[: 10 * len(robot.links)] = random_bodies(rng, len(robot.links)).ravel()
    kinds = tuple(rng.choice(["individually", "in_combination", "no"], len(standard)).tolist())
    base = (BaseValue("ZZR1", "kg m2", 0.25, "ZZ1 + IA1"), BaseValue("MXR2", "kg m", -1e-05, "MX2 - 0.5 M3"))
    return IdentifiedRobot(model, standard, kinds, base)


def brisk(robot: RobotModel, samples: int = 6, seed: int = 1) -> MotionState:
    """Give random states in which no joint and no coupled motor is near standstill."""
    rng = np.random.default_rng(seed)
    joints = len(robot.joints)
    rows = np.zeros((0, joints))
    weights = np.zeros((len(robot.couplings), joints))
    for row, one in zip(weights, robot.couplings, strict=True):
        row[[joint - 1 for joint in one.joints]] = one.weights
    while len(rows) < samples:
        speed = rng.choice([-1.0, 1.0], joints) * rng.uniform(0.5, 2.0, joints)
        if (np.abs(weights @ speed) > 0.3).all():
            rows = np.vstack([rows, speed])
    return MotionState(rng.uniform(-3.0, 3.0, (samples, joints)), rows, rng.normal(size=(samples, joints)))


def link_of(robot: RobotModel, name: str) -> Link:
    return next(link for link in robot.links if link.name == name)
