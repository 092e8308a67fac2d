"""A torque that a controller holds from sample to sample is half a sample early in its log, and no fault."""

import pytest

from tests.core.joint_model.plant import Plant, Run, log_of, recorded, robot_of
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE
from veritorque.core.study import IdentifyRequest, diagnose

QUIET = {"noise": 1e-6, "torque_noise": 0.05, "frequencies": 12, "seconds": 12.0}


def findings(plant: Plant, run: Run) -> list[dict]:
    """Diagnose one joint under its sampled controller."""
    options = {"bootstrap": {"draws": 0}}
    return diagnose(IdentifyRequest(robot_of(), (log_of(recorded(plant, run)),), options))["diagnosis"][
        "findings"
    ]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("coulomb", "run"),
    [(3.0, Run(highest_hz=8.0, **QUIET)), (3.0, Run(highest_hz=3.0, rate=250.0, kp=200.0, kd=15.0, **QUIET))],
    ids=["1 kHz", "250 Hz"],
)
def test_a_held_torque_is_half_a_sample_early_and_doubtful(coulomb, run):
    """Fast motion whose encoder's error goes round the loop: shifts by many samples fit, too, as noise."""
    (found,) = findings(Plant(stiffness=None, coulomb=coulomb), run)
    assert found["cause"] == "time_delay"
    assert found["confidence"] <= CONFIDENCE.doubtful
    assert found["parameters"][0]["value"] == pytest.approx(-0.5 / run.rate, rel=0.1)


@pytest.mark.slow
def test_an_axis_without_any_weight_has_no_body_found_on_it():
    """Its mass is exactly zero, and no centre can be divided by it."""
    run = Run(highest_hz=1.0, rate=250.0, kp=200.0, kd=15.0, seed=10, **{**QUIET, "noise": 1e-7})
    assert all(found["confidence"] <= CONFIDENCE.doubtful for found in findings(Plant(stiffness=None), run))
