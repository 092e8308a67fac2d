"""A joint of unmeasured torque: its own model drives it, and the others are fitted as well as ever."""

import numpy as np
import pytest

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.identification.result import Identification
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.study import IdentifyRequest, identify_in_full

MODEL = standard_model(planar_robot())


def found(estimator: str, silent: int) -> Identification:
    state = swing(2, seconds=10.0)
    noise = 0.02 * np.random.default_rng(1).normal(size=state.position.shape)
    rows = whole_rows(log_of(MODEL, true_parameters(MODEL), state, noise))
    torque = rows.torque.copy()
    torque[:, silent] = 0.0
    log = log_from_arrays("silent", rows.time, rows.position, torque)
    asked = {"estimator": estimator, "bootstrap": {"draws": 0}}
    return identify_in_full(IdentifyRequest(MODEL.robot, (log,), asked))


@pytest.mark.parametrize("silent", [0, 1])
@pytest.mark.parametrize("estimator", ["iv", "piv", "didim", "clie", "cloe"])
def test_the_torque_of_the_other_joint_is_predicted_about_as_well_as_by_least_squares(estimator, silent):
    least, own = (found(name, silent) for name in ("sdp", estimator))
    assert own.convergence.converged
    assert own.validation_total_percent < 3.0 * least.validation_total_percent


@pytest.mark.parametrize("estimator", ["ekf", "srukf"])
def test_a_filter_does_not_take_the_models_own_torque_for_exact(estimator):
    least, own = (found(name, 1) for name in ("sdp", estimator))
    assert own.convergence.converged
    known = own.precision.standard_deviation > 0.0
    apart = np.abs(own.estimate.base - least.estimate.base)[known]
    assert np.all(apart < 5.0 * own.precision.standard_deviation[known])
