"""Let engines that are not ours read an exported file, and ask them for the torque of a motion.

Joints are found by their names, as the file's user finds them. Where a link mimics a joint the engine sees a
joint of its own; it is moved as the file says, and its torque is carried over by virtual work.
"""

from pathlib import Path
from xml.etree import ElementTree as ET

import mujoco
import numpy as np
import pinocchio as pin

from veritorque.core.robot.frames import rotation_rpy
from veritorque.core.signals.state import MotionState

Mimics = dict[str, tuple[str, float, float]]
"""Per mimicking joint its master, ratio and offset."""


def mimics_of_urdf(text: str) -> Mimics:
    return {
        joint.get("name"): (one.get("joint"), float(one.get("multiplier")), float(one.get("offset")))
        for joint in ET.fromstring(text).iter("joint")
        for one in joint.iter("mimic")
    }


def mimics_of_mjcf(text: str) -> Mimics:
    found = {}
    for one in ET.fromstring(text).iterfind("equality/joint"):
        offset, ratio, *rest = map(float, one.get("polycoef").split())
        assert rest == [0.0, 0.0, 0.0]
        found[one.get("joint1")] = (one.get("joint2"), ratio, offset)
    return found


def mimics_of_sdf(text: str) -> Mimics:
    return {
        joint.get("name"): (
            one.get("joint"),
            float(one.findtext("multiplier")),
            float(one.findtext("offset")),
        )
        for joint in ET.fromstring(text).iter("joint")
        for one in joint.iter("mimic")
    }


def pinocchio_of_urdf(text: str) -> pin.Model:
    return pin.buildModelFromXML(text)


def pinocchio_of_mjcf(text: str, folder: Path) -> pin.Model:
    """Read an MJCF; pinocchio takes files only, and keeps gravity to its own."""
    file = folder / "robot.xml"
    file.write_text(text, encoding="utf-8")
    model = pin.buildModelFromMJCF(str(file))
    gravity = ET.fromstring(text).find("option").get("gravity")
    model.gravity = pin.Motion(np.array([float(one) for one in gravity.split()]), np.zeros(3))
    return model


def pinocchio_of_sdf(text: str) -> pin.Model:
    """Read an SDFormat model by its specification: poses in named frames, axes in the child's frame."""
    root = ET.fromstring(text).find("model")
    links = {link.get("name"): link for link in root.iter("link")}
    model, numbers = pin.Model(), {"world": 0}
    base = next(joint for joint in root.iter("joint") if joint.get("type") == "fixed")
    assert base.findtext("parent") == "world"
    fixed = base.findtext("child")
    assert links[fixed].find("pose").get("relative_to") is None
    numbers[fixed], mounted = 0, {fixed: _pose(links[fixed])}
    for joint in root.iter("joint"):
        if joint is base:
            continue
        parent, child = joint.findtext("parent"), joint.findtext("child")
        assert links[child].find("pose").get("relative_to") == parent
        axis = np.array([float(one) for one in joint.findtext("axis/xyz").split()])
        revolute = joint.get("type") == "revolute"
        moving = (pin.JointModelRevoluteUnaligned if revolute else pin.JointModelPrismaticUnaligned)(*axis)
        place = mounted.get(parent, pin.SE3.Identity()) * _pose(links[child])
        numbers[child] = model.addJoint(numbers[parent], moving, place, joint.get("name"))
        inertial = links[child].find("inertial")
        xx, xy, xz, yy, yz, zz = (
            float(inertial.findtext(f"inertia/i{axes}")) for axes in ("xx", "xy", "xz", "yy", "yz", "zz")
        )
        inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        centre = _pose(inertial)
        body = pin.Inertia(
            float(inertial.findtext("mass")),
            centre.translation,
            centre.rotation @ inertia @ centre.rotation.T,
        )
        model.appendBodyToJoint(numbers[child], body, pin.SE3.Identity())
    return model


def pinocchio_torque(model: pin.Model, names: list[str], state: MotionState, mimics: Mimics) -> np.ndarray:
    """Ask pinocchio for the torque (N m or N) of every sample, one column per name."""
    data = model.createData()

    def torque(moves: dict[str, tuple[float, float, float]]) -> dict[str, float]:
        q, dq, ddq = pin.neutral(model), np.zeros(model.nv), np.zeros(model.nv)
        for name, (position, velocity, acceleration) in moves.items():
            joint = model.joints[model.getJointId(name)]
            turned = position if joint.nq == 1 else (np.cos(position), np.sin(position))
            q[joint.idx_q : joint.idx_q + joint.nq] = turned
            dq[joint.idx_v], ddq[joint.idx_v] = velocity, acceleration
        needed = pin.rnea(model, data, q, dq, ddq)
        return {name: needed[model.joints[model.getJointId(name)].idx_v] for name in moves}

    return by_virtual_work(names, state, mimics, torque)


def mujoco_model(text: str) -> mujoco.MjModel:
    """Read a file without limits, which random motion breaks, and without the springs that make mimics."""
    model = mujoco.MjModel.from_xml_string(text)
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_LIMIT | mujoco.mjtDisableBit.mjDSBL_EQUALITY
    return model


def mujoco_torque(model: mujoco.MjModel, names: list[str], state: MotionState, mimics: Mimics) -> np.ndarray:
    """Ask MuJoCo for the torque (N m or N) of every sample, with all that the file says of the drives."""
    data = mujoco.MjData(model)

    def torque(moves: dict[str, tuple[float, float, float]]) -> dict[str, float]:
        places = {name: int(model.joint(name).dofadr[0]) for name in moves}
        for name, place in places.items():
            data.qpos[place], data.qvel[place], data.qacc[place] = moves[name]
        mujoco.mj_inverse(model, data)
        return {name: data.qfrc_inverse[place] for name, place in places.items()}

    return by_virtual_work(names, state, mimics, torque)


def mujoco_acceleration(
    model: mujoco.MjModel, names: list[str], state: MotionState, commanded: np.ndarray
) -> np.ndarray:
    """Let MuJoCo move the robot by its actuators from every state: joint acceleration, per s2."""
    data = mujoco.MjData(model)
    places = [int(model.joint(name).dofadr[0]) for name in names]
    found = np.empty_like(commanded)
    for row, control in enumerate(commanded):
        data.qpos[places], data.qvel[places] = state.position[row], state.velocity[row]
        for name, value in zip(names, control, strict=True):
            data.actuator(name).ctrl = value
        mujoco.mj_forward(model, data)
        found[row] = data.qacc[places]
    return found


def by_virtual_work(names, state, mimics, torque):
    total = np.zeros_like(state.position)
    for row in range(len(total)):
        motion = zip(state.position[row], state.velocity[row], state.acceleration[row], strict=True)
        moves = dict(zip(names, motion, strict=True))
        for name, (master, ratio, offset) in mimics.items():
            position, velocity, acceleration = moves[master]
            moves[name] = (ratio * position + offset, ratio * velocity, ratio * acceleration)
        needed = torque(moves)
        for column, name in enumerate(names):
            total[row, column] = needed[name] + sum(
                ratio * needed[one] for one, (master, ratio, _) in mimics.items() if master == name
            )
    return total


def _pose(element: ET.Element) -> pin.SE3:
    x, y, z, *angles = (float(one) for one in element.findtext("pose").split())
    return pin.SE3(rotation_rpy(*angles), np.array([x, y, z]))
