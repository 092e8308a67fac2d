"""The estimator that is chosen: least squares unless noise biases it, with the reason in the result."""

import numpy as np
import pytest

from tests.core.estimate.sticking_arm import scene
from veritorque.core.document.estimation import estimation_fields
from veritorque.core.errors import OptionError, SolverError
from veritorque.core.estimate.problem import Problem
from veritorque.core.identification.choice import choose
from veritorque.core.identification.options import parse_diagnose_options
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.study import IdentifyRequest, identify_in_full

NO_DRAWS = {"bootstrap": {"draws": 0}}


def found_by(log, **options):
    """Fit a log of the arm that sticks."""
    return identify_in_full(IdentifyRequest(scene("planar-2").world.arm.robot, (log,), NO_DRAWS | options))


def test_a_quiet_log_is_fitted_by_least_squares_to_the_bit():
    log = scene("planar-2").log(1e-3, 0.02, 0)
    chosen, least = (found_by(log, estimator=name) for name in ("auto", "sdp"))
    np.testing.assert_array_equal(chosen.estimate.base, least.estimate.base)
    assert chosen.estimator == "sdp"
    assert "attenuates no inertia" in chosen.choice.reason
    assert least.choice is None


@pytest.mark.parametrize("robot", ["planar-2", "ur10e"])
def test_a_coarse_encoder_s_log_is_fitted_to_simulated_motion_and_errs_less(robot):
    own = scene(robot)
    log = own.log(0.1, 0.02, 0)
    chosen = identify_in_full(IdentifyRequest(own.world.arm.robot, (log,), NO_DRAWS | {"estimator": "auto"}))
    assert chosen.estimator == "cloe"
    assert own.error(chosen.estimate.base) < 0.5 * own.error(own.estimated(log, "sdp", {}))
    fields = estimation_fields(chosen)
    assert fields["choice"]["reason"] in fields["statements"][0]
    assert "attenuates the inertia of joint" in fields["choice"]["reason"]


def test_options_of_both_estimators_are_taken():
    log = scene("planar-2").log(0.1, 0.02, 0)
    wide = found_by(log, estimator="auto", robust=True, simulation={"bandwidth_hz": 3.0})
    assert wide.estimator == "cloe"
    assert wide.simulation.options.bandwidth_hz == 3.0


def test_a_log_that_cannot_be_simulated_is_fitted_by_least_squares_and_says_so():
    own = scene("planar-2")
    found = found_by(own.log(0.1, 0.02, 0), estimator="sdp")
    problem = Problem(found.base, found.motions, found.held_out)

    def diverges():
        raise SolverError("the simulated motion diverges", evidence={}, remedy="")

    answer, choice = choose(problem, found, found.attenuation, diverges)
    assert answer is found
    assert choice.estimator == "sdp"
    assert "cannot be simulated: the simulated motion diverges" in choice.reason


def test_a_controller_that_was_asked_for_and_is_not_in_the_log_is_refused():
    rows = whole_rows(scene("planar-2").log(0.1, 0.02, 0))
    bare = log_from_arrays("bare", rows.time, rows.position, rows.torque, position_ref=rows.position)
    with pytest.raises(OptionError, match="does not show its controller"):
        found_by(bare, estimator="auto", simulation={"from": "controller"})


def test_a_diagnosis_is_made_by_least_squares_only():
    with pytest.raises(OptionError, match="cannot be fitted by"):
        parse_diagnose_options({"estimator": "auto"})
