"""Build an arm in MuJoCo, link by link and body by body, never through a file of ours."""

import mujoco
import numpy as np

from tests.plant.robots import Arm
from veritorque.core.robot.inertia import mass_properties

STEPS_PER_SECOND = 2000


def build(arm: Arm, split: tuple[int, ...] = (), *, loads: int = 0) -> mujoco.MjModel:
    """Build the arm link by link.

    Joints of `split` (from 0) get a rotor of their own, after all links; the last link gets bodies for loads.
    """
    spec = mujoco.MjSpec()
    spec.option.gravity = arm.robot.gravity
    spec.option.timestep = 1.0 / STEPS_PER_SECOND
    spec.option.disableflags = mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_REFSAFE
    spec.compiler.degree = False
    spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    part = spec.worldbody
    for link, body in zip(arm.robot.links, arm.bodies, strict=True):
        part = part.add_body(name=link.name, pos=link.translation, quat=_quaternion(link.rotation))
        part.add_joint(name=link.name, type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0.0, 0.0, 1.0])
        mass, centre, inertia = mass_properties(body)
        moments, axes = np.linalg.eigh(inertia)
        axes[:, 0] *= np.sign(np.linalg.det(axes))
        part.explicitinertial = True
        part.mass, part.ipos, part.inertia, part.iquat = mass, centre, moments, _quaternion(axes)
    for number in range(loads):
        load = part.add_body(name=f"load_{number}")
        load.explicitinertial = True
        load.mass, load.inertia = 1e-9, [1e-12, 1e-12, 1e-12]
    for joint in split:
        rotor = spec.worldbody.add_body(name=f"rotor_{joint}")
        rotor.add_joint(name=f"rotor_{joint}", type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0.0, 0.0, 1.0])
        rotor.explicitinertial = True
        rotor.mass, rotor.inertia = 1e-9, [1e-12, 1e-12, 1e-12]
    for coupling in arm.robot.couplings:
        tendon = spec.add_tendon(name=coupling.name)
        for joint, weight in zip(coupling.joints, coupling.weights, strict=True):
            tendon.wrap_joint(arm.robot.links[joint - 1].name, weight)
    return spec.compile()


def inverse(model: mujoco.MjModel, motion: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
    """Give the torque (N m) that MuJoCo's rigid bodies need along position, velocity and acceleration."""
    data = mujoco.MjData(model)
    torque = np.empty_like(motion[0])
    for row, (position, velocity, acceleration) in enumerate(zip(*motion, strict=True)):
        data.qpos[:], data.qvel[:], data.qacc[:] = position, velocity, acceleration
        mujoco.mj_inverse(model, data)
        torque[row] = data.qfrc_inverse
    return torque


def inertia(model: mujoco.MjModel, position: np.ndarray) -> np.ndarray:
    """Give the diagonal of the mass matrix, kg m2."""
    data = mujoco.MjData(model)
    data.qpos[:] = position
    mujoco.mj_forward(model, data)
    full = np.empty((model.nv, model.nv))
    for column, unit in zip(full, np.eye(model.nv), strict=True):
        mujoco.mj_mulM(model, data, column, unit)
    return np.diag(full).copy()


def _quaternion(rotation: np.ndarray) -> np.ndarray:
    """Write a rotation as w, x, y, z."""
    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(rotation).ravel())
    return quaternion
