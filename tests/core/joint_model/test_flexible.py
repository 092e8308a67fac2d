"""A joint's spring is found where the log shows it, and refused where it does not."""

import numpy as np
import pytest

from tests.core.joint_model.plant import Plant, Run, log_of, recorded, robot_of
from veritorque.core.identification.identify import no_progress
from veritorque.core.joint_model.identify import identify_joint
from veritorque.core.joint_model.options import JointOptions
from veritorque.core.joint_model.result import JointModel

ENCODER = np.radians(1e-3)


def identified(plant: Plant, run: Run, **options: str) -> JointModel:
    """Record a log, and identify its joint."""
    return identify_joint(robot_of(), log_of(recorded(plant, run)), JointOptions(1, **options), no_progress)


def errors(found: JointModel, plant: Plant) -> dict[str, tuple[float, float]]:
    """Give the errors of the flexible model's parameters, as shares of the values and in deviations."""
    true = {
        "motor_inertia": plant.motor,
        "link_inertia": plant.link,
        "stiffness": plant.stiffness,
        "damping": plant.damping,
        "viscous": plant.viscous,
    }
    known = {name: found.flexible.parameters.at(name) for name in true}
    return {
        name: (value / true[name] - 1.0, (value - true[name]) / deviation)
        for name, (value, deviation) in known.items()
    }


@pytest.mark.parametrize("mode", [8.0, 12.0, 25.0, 40.0])
@pytest.mark.parametrize("estimator", ["srivc", "clsrivc"])
def test_without_noise_the_joint_is_recovered_at_every_mode(mode, estimator):
    plant = Plant.with_mode(mode)
    found = identified(plant, Run(highest_hz=1.5 * mode, seconds=6.0), estimator=estimator)
    assert found.flexible.failure is None
    assert max(abs(share) for share, _ in errors(found, plant).values()) < 1e-4
    np.testing.assert_allclose(found.flexible.modes.values[0], mode, rtol=1e-4)


@pytest.mark.parametrize("mode", [8.0, 12.0, 25.0, 40.0])
def test_with_a_noisy_encoder_every_parameter_lies_within_three_deviations_and_one_per_cent(mode):
    plant = Plant.with_mode(mode)
    found = identified(plant, Run(highest_hz=1.5 * mode, noise=ENCODER), estimator="clsrivc")
    assert found.flexible.failure is None
    for name, (share, deviations) in errors(found, plant).items():
        assert abs(deviations) < 3.0, name
        assert abs(share) < (0.02 if name == "damping" else 0.01), name
    # and the position that is simulated under the controller is off by the encoder's noise alone
    assert found.flexible.held_out.position_rms == pytest.approx(ENCODER, rel=0.05)
