"""Give the rank of a URDF's regressor by pinocchio: its own reader, its own dynamics, its own numbering.

Joints that mimic others are moved with them and their torque is gathered by virtual work. Every joint has a
rotor inertia, viscous and Coulomb friction and an offset, as a robot has that declares nothing else.
"""

from dataclasses import dataclass
from xml.etree import ElementTree as ET

import numpy as np
import pinocchio as pin

SEPARATED = 30.0
"""The rank is clear where the last singular value that counts is so many times the first that does not, and
neither is so near the tolerance."""
ROUNDING = 1e-10
"""Singular values below this share of the largest do not count. Pinocchio's rounding lies near 1e-15; what
three twists of a milliradian leave together lies near 1e-9, so that some robots have one at any tolerance."""
NOTHING = 1e-12
"""Columns below this share of the largest are rounding."""


@dataclass(frozen=True)
class Rank:
    """Hold a numerical rank, with the singular values (of unit columns) on either side of it."""

    count: int
    last: float
    next: float
    least: int
    most: int
    """Numbers that count at a tolerance `SEPARATED` times larger and smaller: between these any is right."""

    @property
    def is_clear(self) -> bool:
        """Tell whether a gap separates what counts from what does not, wherever the tolerance lies in it."""
        return self.last > SEPARATED * self.next and self.least == self.most


def rank_of(text: str, seed: int) -> Rank:
    """Give the rank of the joint torque regressor at random states."""
    model = pin.buildModelFromXML(text)
    data, rng = model.createData(), np.random.default_rng(seed)
    owners, ratios, offsets = _drives(model, text)
    joints = sorted(set(owners))
    gather = np.array([ratios * (owners == joint) for joint in joints])
    blocks = []
    for _ in range(max(40, 80 * model.nv // len(joints) // 4)):
        q, dq, ddq = rng.uniform(-np.pi, np.pi, len(joints)), *rng.normal(scale=2.0, size=(2, len(joints)))
        angles, speeds, changes = gather.T @ q + offsets, gather.T @ dq, gather.T @ ddq
        regressor = pin.computeJointTorqueRegressor(model, data, _state(model, angles), speeds, changes)
        bodies = gather @ regressor.reshape(model.nv, -1)  # one joint's regressor comes as a vector
        drives = [np.diag(part) for part in (ddq, dq, np.sign(dq), np.ones(len(joints)))]
        blocks.append(np.hstack([bodies, *drives]))
    return _rank(np.vstack(blocks))


def _rank(matrix: np.ndarray) -> Rank:
    size = np.linalg.norm(matrix, axis=0)
    used = size > NOTHING * size.max()
    values = np.append(np.linalg.svd(matrix[:, used] / size[used], compute_uv=False), 0.0)
    shares = values / values[0]
    count, least, most = (int((shares > ROUNDING * by).sum()) for by in (1.0, SEPARATED, 1.0 / SEPARATED))
    return Rank(count, float(values[count - 1]), float(values[count]), least, most)


def _state(model: pin.Model, angles: np.ndarray) -> np.ndarray:
    """Write joint angles as pinocchio's configuration, in which a continuous joint is a point on a circle."""
    q = pin.neutral(model)
    for joint in list(model.joints)[1:]:
        angle = angles[joint.idx_v]
        q[joint.idx_q : joint.idx_q + joint.nq] = angle if joint.nq == 1 else (np.cos(angle), np.sin(angle))
    return q


def _drives(model: pin.Model, text: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Say per velocity of pinocchio which one drives it, by which ratio and offset."""
    owners, ratios, offsets = np.arange(model.nv), np.ones(model.nv), np.zeros(model.nv)
    places = {name: model.joints[model.getJointId(name)].idx_v for name in list(model.names)[1:]}
    for joint in ET.fromstring(text).iter("joint"):
        mimic = joint.find("mimic")
        if mimic is not None:
            own = places[joint.get("name")]
            owners[own] = places[mimic.get("joint")]
            ratios[own], offsets[own] = float(mimic.get("multiplier")), float(mimic.get("offset"))
    return owners, ratios, offsets
