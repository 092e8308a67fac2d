"""Check that the robot's mass matrix is positive along the motion and all over the workspace.

M(q) > 0 is what the seed paper checks after the fact. Here it follows: links whose pseudo-inertias are
positive definite have positive kinetic energy in every motion, so M(q) > 0 everywhere; the numbers below
confirm it and tell how close to singular it comes. Source: Wensing, Kim & Slotine 2018; the seed paper,
section 3.2.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import JointSeries, Parameters
from ..dynamics.model import DynamicModel
from ..regressor.columns import all_columns
from ..robot.inertia import pseudo_inertia
from ..robot.model import RobotModel
from ..signals.state import MotionState

CONFIGURATIONS = 10_000
_INERTIAL_TERMS = ("rigid_body", "rotor_inertia", "coupling")
_CHUNK = 2_000
_SEED = 733


@dataclass(frozen=True, eq=False)
class MassMatrixCheck:
    """Hold the smallest eigenvalue met (kg m2.

    Mixed units with prismatic joints) and whether Cholesky passed everywhere.
    """

    min_eigenvalue: float
    positive: bool
    configurations: int


def mass_matrices(model: DynamicModel, standard: Parameters, position: JointSeries) -> np.ndarray:
    """Give M(q) for every row of positions: the torque of unit accelerations, at rest and without gravity."""
    inertial = _inertial(model)
    column_of = {parameter.name: column for column, parameter in enumerate(model.parameters)}
    values = np.array([standard[column_of[parameter.name]] for parameter in inertial.parameters])
    joints = len(model.robot.joints)
    repeated = np.repeat(position, joints, axis=0)
    unit = np.tile(np.eye(joints), (len(position), 1))
    plan = all_columns(inertial)
    series = plan.series(MotionState(repeated, np.zeros_like(unit), unit))
    torque = np.zeros((len(unit), joints))
    for (joint, column), row in zip(plan.entries, series, strict=True):
        torque[:, joint] += values[column] * row
    return torque.reshape(len(position), joints, joints)


def check_mass_matrix(model: DynamicModel, standard: Parameters, position: JointSeries) -> MassMatrixCheck:
    """Check M(q) at every row of positions."""
    smallest, positive = np.inf, True
    for start in range(0, len(position), _CHUNK):
        matrices = mass_matrices(model, standard, position[start : start + _CHUNK])
        symmetric = 0.5 * (matrices + matrices.transpose(0, 2, 1))
        smallest = min(smallest, float(np.linalg.eigvalsh(symmetric)[:, 0].min()))
        positive = positive and _cholesky_passes(symmetric)
    return MassMatrixCheck(smallest, positive, len(position))


def workspace(robot: RobotModel, configurations: int = CONFIGURATIONS) -> JointSeries:
    """Draw configurations inside the joint limits, evenly and with a fixed seed (rad, m)."""
    rng = np.random.default_rng(_SEED)
    share = rng.random((configurations, len(robot.joints)))
    return np.asarray(robot.lower_positions + share * (robot.upper_positions - robot.lower_positions))


def pseudo_inertia_eigenvalues(model: DynamicModel, standard: Parameters) -> tuple[float, ...]:
    """Give the smallest eigenvalue of every link's pseudo-inertia (mixed units kg m2, kg m, kg)."""
    columns = {parameter.name: column for column, parameter in enumerate(model.parameters)}
    links = range(1, len(model.robot.links) + 1)
    firsts = [columns[f"XX{link}"] for link in links if f"XX{link}" in columns]
    return tuple(
        float(np.linalg.eigvalsh(pseudo_inertia(standard[first : first + 10]))[0]) for first in firsts
    )


def _inertial(model: DynamicModel) -> DynamicModel:
    weightless = replace(model.robot, gravity=np.zeros(3))
    return DynamicModel(weightless, tuple(term for term in model.terms if term.name in _INERTIAL_TERMS))


def _cholesky_passes(matrices: np.ndarray) -> bool:
    try:
        np.linalg.cholesky(matrices)
    except np.linalg.LinAlgError:
        return False
    return True
