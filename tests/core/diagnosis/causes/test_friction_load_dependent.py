"""Load-dependent friction follows the torque through the transmission, without the motor-side inertia."""

import numpy as np
import pytest

from tests.core.diagnosis.made_up import nothing_found
from tests.core.diagnosis.scenes import fitter_of, measured_arm, skew_arm
from tests.core.diagnosis.test_diagnose import asked
from tests.core.estimate.worlds import true_parameters
from veritorque.core.diagnosis.causes.friction_load_dependent import FrictionLoadDependent
from veritorque.core.diagnosis.causes.protocol import Setting
from veritorque.core.diagnosis.diagnose import diagnose
from veritorque.core.diagnosis.search.hypothesis import Candidate
from veritorque.core.diagnosis.search.profile_likelihood import neighbours, refine_scalars
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.prediction import Prediction

ROTOR, SHARE = 1.5, 0.15
"""Inertia of the rotor that the skew arm's description leaves out, kg m2, and friction per torque."""


def loaded(state):
    """Add an undeclared rotor to joint 1, and friction that depends on the transmitted torque."""
    model = standard_model(skew_arm())
    load = Prediction(model, true_parameters(model)).load(state)[:, 0]
    friction = SHARE * np.sign(state.velocity[:, 0]) * np.abs(load)
    return (ROTOR * state.acceleration[:, 0] + friction)[:, None] * [1.0, 0.0, 0.0]


def test_friction_separates_the_rotor_that_no_fit_separates_from_its_link():
    (found,) = diagnose(asked(measured_arm(loaded))).findings
    assert (found.cause, found.joints) == ("friction_load_dependent", (1,))
    share, rotor = found.quantities
    assert (rotor.name, rotor.unit) == ("motor_inertia", "kg m2")
    assert abs(share.value - SHARE) < 3.0 * share.standard_deviation
    assert abs(rotor.value - ROTOR) < 3.0 * rotor.standard_deviation
    assert rotor.standard_deviation < 0.2 * ROTOR
    assert "motor-side inertia" in found.statement


def test_a_rotor_never_has_more_inertia_than_the_joint():
    scene = measured_arm()
    shares = [
        one["motor_inertia"]
        for one in FrictionLoadDependent().grid(Setting(scene.dataset, scene.operating_point, (1,)))
    ]
    least = scene.operating_point.slopes(scene.dataset.state, 0)[2][:, 0].min()
    farthest = neighbours(shares, shares[-1])[1]
    assert 0.9 * least < farthest < least


def test_a_rotor_that_was_scanned_once_is_refined_where_no_grid_has_it_any_more():
    fitter = fitter_of(measured_arm(), (FrictionLoadDependent(),))
    none = nothing_found(fitter)
    found = refine_scalars(
        fitter, none, Candidate(FrictionLoadDependent(), (3,), {"motor_inertia": 0.1}, 1.0)
    )
    assert 0.05 <= found.scalars["motor_inertia"] <= 0.2


@pytest.mark.parametrize(("joint", "points"), [(1, 4), (3, 1)], ids=["unknown", "known"])
def test_a_rotor_is_scanned_only_where_it_is_part_of_the_link(joint, points):
    scene = measured_arm()
    grid = FrictionLoadDependent().grid(Setting(scene.dataset, scene.operating_point, (joint,)))
    assert len(grid) == points
    assert {name for scalars in grid for name in scalars} == ({"motor_inertia"} if points > 1 else set())
