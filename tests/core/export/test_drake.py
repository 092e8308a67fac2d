"""Drake, whose reader of SDFormat is Gazebo's own, needs the torque that our model predicts.

Drake is no dependency of the tests, being a wheel of 42 MB that brings matplotlib: ``pip install drake`` runs
them. Tolerance as in `test_engines`.
"""

import numpy as np
import pytest

from tests.core.export import engines
from tests.core.export.robots import ROBOTS, brisk, identified
from tests.core.export.test_engines import TOLERANCE, of_terms
from veritorque.core.export.sdf import write_sdf

REASON = "Drake is not installed: nobody but our own reader reads the SDFormat here (pip install drake)"
parsing = pytest.importorskip("pydrake.multibody.parsing", reason=REASON)
plants = pytest.importorskip("pydrake.multibody.plant", reason=REASON)
trees = pytest.importorskip("pydrake.multibody.tree", reason=REASON)


@pytest.fixture(params=ROBOTS, scope="module")
def found(request):
    return identified(ROBOTS[request.param])


@pytest.fixture(scope="module")
def plant(found):
    """Drake's robot, in a world with the robot's gravity."""
    plant = plants.MultibodyPlant(0.001)
    plant.set_discrete_contact_approximation(plants.DiscreteContactApproximation.kSap)
    parsing.Parser(plant).AddModelsFromString(write_sdf(found), "sdf")
    down = [0.0, 0.0, -float(np.linalg.norm(found.robot.gravity))]
    plant.mutable_gravity_field().set_gravity_vector(down)
    plant.Finalize()
    return plant


def test_drake_reads_every_mimic_and_every_limit(found, plant):
    assert plant.num_constraints() == len(found.robot.links) - len(found.robot.joints)
    for joint in found.robot.joints:
        read = plant.GetJointByName(joint.name)
        lower, upper = joint.limits.position or (-np.inf, np.inf)
        assert (read.position_lower_limits()[0], read.position_upper_limits()[0]) == (lower, upper)


def test_drake_needs_the_torque_of_bodies_rotors_and_viscous_friction(found, plant):
    names, state = [joint.name for joint in found.robot.joints], brisk(found.robot, samples=50)
    context = plant.CreateDefaultContext()

    def torque(moves):
        places = {name: plant.GetJointByName(name).velocity_start() for name in moves}
        position, velocity, acceleration = np.zeros((3, plant.num_velocities()))
        for name, place in places.items():
            position[place], velocity[place], acceleration[place] = moves[name]
        plant.SetPositions(context, position)
        plant.SetVelocities(context, velocity)
        forces = trees.MultibodyForces(plant)
        plant.CalcForceElementsContribution(context, forces)  # gravity and damping
        needed = plant.CalcInverseDynamics(context, acceleration, forces)
        return {name: needed[place] for name, place in places.items()}

    theirs = engines.by_virtual_work(names, state, engines.mimics_of_sdf(write_sdf(found)), torque)
    ours = of_terms(found, state, "rigid_body", "rotor_inertia", "viscous")
    np.testing.assert_allclose(theirs, ours, rtol=0, atol=TOLERANCE)
