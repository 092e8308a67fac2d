"""Hold what a log of one moving joint gives: its own parameters, and no end for what only others tell."""

import numpy as np

from tests.core.estimate.worlds import planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.study import IdentifyRequest, identify


def test_one_joint_that_moves_is_identified_while_the_other_stands():
    model = standard_model(planar_robot())
    state = swing(2)
    for series in (state.velocity, state.acceleration):
        series[:, 0] = 0.0
    state.position[:, 0] = 0.3
    truth = true_parameters(model)
    torque = model.torque(truth, state) + 0.01 * np.random.default_rng(1).normal(size=state.position.shape)
    log = log_from_arrays("one", np.arange(len(torque)) / 100.0, state.position, torque)
    document = identify(IdentifyRequest(model.robot, (log,), {"bootstrap": {"draws": 0}}))
    found = {row["name"]: row for row in document["base_parameters"]}
    friction = dict(zip([one.name for one in model.parameters], truth, strict=True))
    for name in ("FV2", "FC2"):
        assert abs(found[name]["value"] - friction[name]) < 4.0 * found[name]["standard_deviation"]
    assert [row["quality"] for row in document["validation"]] == [None, "good"]
    assert document["feasibility"]["ols_feasible"] in (True, False, None)
