"""Hold the Jacobian against pinocchio's, for chains and trees with turning and sliding joints."""

import numpy as np
import pinocchio as pin

from tests.tools import pinocchio_model, random_bodies, random_motion, random_robot
from veritorque.core.dynamics.jacobian import jacobian


def test_the_jacobian_of_any_link_is_pinocchios():
    rng = np.random.default_rng(0)
    for tree in (False, True):
        robot = random_robot(rng, 7, tree=tree)
        motion = random_motion(rng, 7)
        model = pinocchio_model(robot, random_bodies(rng, 7))
        data = model.createData()
        for link in (1, 4, 7):
            ours = jacobian(robot, link, motion.position)
            for q, found in zip(motion.position, ours, strict=True):
                theirs = pin.computeJointJacobian(model, data, q, link)
                pin.forwardKinematics(model, data, q)
                local = data.oMi[link].rotation
                turned = np.vstack([local @ theirs[:3], local @ theirs[3:]])
                np.testing.assert_allclose(found, turned, atol=1e-12)
