"""Make random robots and motions, and ask engines that are not ours what torque they need.

pinocchio and MuJoCo are given the robot link by link and body by body, never through a file of ours. Both
engines see one joint per link; where a link mimics a joint, its torque is carried over by virtual work.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from veritorque.core.robot.frames import rotation_rpy
from veritorque.core.robot.inertia import from_mass_properties, mass_properties
from veritorque.core.robot.model import Joint, Link, RobotModel

SHARED = Path(__file__).resolve().parents[1] / ".." / "shared"


@dataclass(frozen=True, eq=False)
class Motion:
    """Hold samples of position (rad or m), velocity and acceleration, one column per joint."""

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray


Engine = Callable[[RobotModel, np.ndarray, Motion], np.ndarray]


def shared(path: str) -> Path:
    """Give a file of the shared measurements, or skip the test and say which file is missing."""
    file = SHARED / path
    if not file.exists():
        pytest.skip(f"SKIPPED FOR WANT OF DATA: shared/{path} is not there")
    return file


def random_robot(
    rng: np.random.Generator, links: int, *, tree: bool = False, prismatic: float = 0.3, gravity: bool = True
) -> RobotModel:
    """Make a robot with links of skew placements; a share of `prismatic` joints slides."""
    parts = tuple(
        Link(
            name=f"link_{number}",
            kind="prismatic" if rng.random() < prismatic else "revolute",
            antecedent=int(rng.integers(0, number)) if tree else number - 1,
            joint=number,
            rotation=rotation_rpy(*rng.uniform(-np.pi, np.pi, 3)),
            translation=rng.normal(scale=0.3, size=3),
        )
        for number in range(1, links + 1)
    )
    down = rng.normal(size=3)
    return RobotModel(
        name="random",
        links=parts,
        joints=tuple(Joint(f"joint_{number}") for number in range(1, links + 1)),
        gravity=9.81 * down / np.linalg.norm(down) * float(gravity),
    )


def random_bodies(rng: np.random.Generator, links: int, *, mass: float = 2.0) -> np.ndarray:
    """Make physically consistent bodies, of about the given mass (kg), the size of a hand."""
    return np.array([_random_body(rng, mass * rng.uniform(0.5, 1.5)) for _ in range(links)])


def _random_body(rng: np.random.Generator, mass: float) -> np.ndarray:
    spread = rng.normal(scale=0.1, size=(3, 3)) + 0.05 * np.eye(3)
    second = mass * spread @ spread.T
    return from_mass_properties(mass, rng.normal(scale=0.15, size=3), np.trace(second) * np.eye(3) - second)


def random_motion(rng: np.random.Generator, joints: int, samples: int = 5, *, speed: float = 1.0) -> Motion:
    """Make samples of motion; a `speed` of zero stands still."""
    return Motion(
        rng.uniform(-np.pi, np.pi, (samples, joints)),
        speed * rng.normal(size=(samples, joints)),
        speed * rng.normal(size=(samples, joints)),
    )


def with_mimics(robot: RobotModel, rng: np.random.Generator) -> RobotModel:
    """Let the last third of the links follow joints of the others, with ratios and offsets."""
    own = len(robot.links) - len(robot.links) // 3
    links = tuple(
        link
        if number <= own
        else Link(
            link.name,
            link.kind,
            link.antecedent,
            int(rng.integers(1, own + 1)),
            link.rotation,
            link.translation,
            ratio=float(rng.uniform(-2.0, 2.0)),
            offset=float(rng.normal()),
        )
        for number, link in enumerate(robot.links, start=1)
    )
    return RobotModel(robot.name, links, robot.joints[:own], robot.gravity)


def pinocchio_torque(robot: RobotModel, bodies: np.ndarray, motion: Motion) -> np.ndarray:
    """Ask pinocchio for the torque (N m or N) of every sample."""
    model = pinocchio_model(robot, bodies)
    data = model.createData()
    return _by_link(robot, motion, lambda q, dq, ddq: pin.rnea(model, data, q, dq, ddq))


def pinocchio_model(robot: RobotModel, bodies: np.ndarray) -> pin.Model:
    """Build a pinocchio model with one joint per link."""
    model = pin.Model()
    model.gravity = pin.Motion(np.asarray(robot.gravity), np.zeros(3))
    numbers = [0]
    for link, body in zip(robot.links, bodies, strict=True):
        joint = pin.JointModelRZ() if link.kind == "revolute" else pin.JointModelPZ()
        placement = pin.SE3(link.rotation, link.translation)
        number = model.addJoint(numbers[link.antecedent], joint, placement, link.name)
        mass, centre, inertia = mass_properties(body)
        model.appendBodyToJoint(number, pin.Inertia(mass, centre, inertia), pin.SE3.Identity())
        numbers.append(number)
    return model


def mujoco_torque(robot: RobotModel, bodies: np.ndarray, motion: Motion) -> np.ndarray:
    """Ask MuJoCo for the torque (N m or N) of every sample."""
    model = mujoco_model(robot, bodies)
    data = mujoco.MjData(model)
    # MuJoCo numbers bodies depth first, a RobotModel does not have to: every joint is found by its name.
    places = [int(model.joint(link.name).dofadr[0]) for link in robot.links]

    def torque(q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        data.qpos[places], data.qvel[places], data.qacc[places] = q, dq, ddq
        mujoco.mj_inverse(model, data)
        return data.qfrc_inverse[places]

    return _by_link(robot, motion, torque)


def mujoco_model(robot: RobotModel, bodies: np.ndarray) -> mujoco.MjModel:
    """Build a MuJoCo model with one joint per link."""
    spec = mujoco.MjSpec()
    spec.option.gravity = robot.gravity
    spec.compiler.degree = False
    spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    parts = [spec.worldbody]
    kinds = {"revolute": mujoco.mjtJoint.mjJNT_HINGE, "prismatic": mujoco.mjtJoint.mjJNT_SLIDE}
    for link, body in zip(robot.links, bodies, strict=True):
        mass, centre, inertia = mass_properties(body)
        moments, axes = np.linalg.eigh(inertia)
        axes[:, 0] *= np.sign(np.linalg.det(axes))
        part = parts[link.antecedent].add_body(
            name=link.name, pos=link.translation, quat=_quaternion(link.rotation)
        )
        part.add_joint(name=link.name, type=kinds[link.kind], axis=[0.0, 0.0, 1.0])
        part.explicitinertial = True
        part.mass, part.ipos, part.inertia, part.iquat = mass, centre, moments, _quaternion(axes)
        parts.append(part)
    return spec.compile()


def _quaternion(rotation: np.ndarray) -> np.ndarray:
    x, y, z, w = pin.Quaternion(np.asarray(rotation)).coeffs()
    return np.array([w, x, y, z])


def _by_link(robot: RobotModel, motion: Motion, torque: Callable[..., np.ndarray]) -> np.ndarray:
    """Move every link as its joint tells it, and gather the links' torques on the joints by virtual work."""
    joints = [link.joint - 1 for link in robot.links]
    ratios = np.array([link.ratio for link in robot.links])
    offsets = np.array([link.offset for link in robot.links])
    total = np.zeros_like(motion.position)
    for sample in range(len(total)):
        position, velocity, acceleration = (
            ratios * series[sample, joints]
            for series in (motion.position, motion.velocity, motion.acceleration)
        )
        np.add.at(total[sample], joints, ratios * torque(position + offsets, velocity, acceleration))
    return total


ENGINES: dict[str, Engine] = {"pinocchio": pinocchio_torque, "mujoco": mujoco_torque}


def relative_difference(one: np.ndarray, other: np.ndarray) -> float:
    """Give, for the worst joint, the largest difference over the joint's largest value."""
    return float(np.max(np.abs(one - other).max(axis=0) / np.abs(other).max(axis=0)))
