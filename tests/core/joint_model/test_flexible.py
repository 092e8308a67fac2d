"""A joint's spring is found where the log shows it, and refused where it does not."""

import re

import numpy as np
import pytest

from tests.core.estimate.flexible_arm import ONE
from tests.core.estimate.flexible_arm import recorded as moved_in_engine
from tests.core.joint_model.plant import Plant, Run, log_of, recorded, robot_of
from veritorque.core.document.joint_model import joint_document
from veritorque.core.errors import ExcitationError, OptionError, SolverError
from veritorque.core.identification.identify import no_progress
from veritorque.core.joint_identification import JointRequest, model_joint
from veritorque.core.joint_model import responses
from veritorque.core.joint_model.identify import identify_joint
from veritorque.core.joint_model.options import JointOptions
from veritorque.core.joint_model.result import JointModel
from veritorque.core.log.reader import log_from_arrays

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


def moved(signals: dict[str, np.ndarray], samples: int) -> dict[str, np.ndarray]:
    """Write the torque down so many samples later, or earlier."""
    ahead, behind = max(samples, 0), max(-samples, 0)
    rows = slice(ahead, len(signals["time"]) - behind)
    kept = slice(behind, len(signals["time"]) - ahead)
    return {name: series[kept if name == "torque" else rows] for name, series in signals.items()}


@pytest.mark.parametrize(
    ("plant", "order"), [(Plant.with_mode(12.0), "flexible"), (Plant(stiffness=None, coulomb=3.0), "rigid")]
)
def test_a_torque_that_is_late_or_early_in_the_log_is_measured_and_warned_of(plant, order):
    run = Run(highest_hz=18.0, seconds=6.0, noise=ENCODER, torque_noise=0.3)
    signals = recorded(plant, run)
    for samples in (0, 2, -2):
        found = identify_joint(
            robot_of(), log_of(moved(signals, samples)), JointOptions(1, order), no_progress
        )
        doubts = joint_document(found, version="", options={})["doubts"]
        late, deviation = found.models[-1].late
        assert late == pytest.approx(samples / run.rate, abs=0.4 / run.rate + 3.0 * deviation)
        assert any("it acted" in doubt for doubt in doubts) == (samples != 0)


def test_the_time_of_a_late_torque_is_that_of_the_reported_model_and_open_where_the_flexible_one_is_refused():
    run = Run(highest_hz=37.0, seconds=6.0, noise=ENCODER, torque_noise=0.3)
    signals = recorded(Plant.with_mode(25.0), run)
    for samples, order in ((2, "flexible"), (5, "rigid")):
        late = log_of(moved(signals, samples))
        found = identify_joint(robot_of(), late, JointOptions(1), no_progress)
        answer = [model for model in found.models if model.failure is None][-1]
        assert answer.order == order
        doubts = joint_document(found, version="", options={})["doubts"]
        (doubt,) = (one for one in doubts if "it acted" in one)
        times = [float(number) for number in re.findall(r"(-?[\d.]+) ms \(", doubt)]
        assert min(times) <= 1e3 * samples / run.rate
        if order == "flexible":
            assert times == [pytest.approx(1e3 * answer.late[0], rel=0.05)]
        else:  # the spring in the rigid model looks like a longer delay
            assert max(times) > 1e3 * samples / run.rate
            assert "not known" in doubt


def test_a_torque_that_no_controller_holds_between_samples_is_no_late_one():
    run = moved_in_engine(ONE, highest_hz=18.0, seconds=10.0)
    for every in (1, 4):
        log = log_from_arrays("motor", run.time[::every], run.position[::every], run.torque[::every])
        found = identify_joint(ONE.robot, log, JointOptions(1, "flexible"), no_progress)
        assert found.models[-1].late[0] == pytest.approx(0.5 / log.rate_hz, rel=0.1)
        doubts = joint_document(found, version="", options={})["doubts"]
        assert not any("it acted" in doubt for doubt in doubts)


MODES = [8.0, 12.0, 25.0, 40.0]


@pytest.mark.parametrize("mode", MODES)
def test_without_noise_the_joint_is_recovered_at_every_mode(mode):
    plant = Plant.with_mode(mode)
    found = identified(plant, Run(highest_hz=1.5 * mode, seconds=4.0))
    assert found.flexible.failure is None
    assert found.flexible.fitted.converged
    # the filters are exact for a held torque, and what is left is rounding of the log's stamps
    assert max(abs(share) for share, _ in errors(found, plant).values()) < 1e-4
    np.testing.assert_allclose(found.flexible.modes.values[0], mode, rtol=1e-4)


@pytest.mark.parametrize("mode", MODES)
def test_with_a_noisy_encoder_every_parameter_lies_within_three_deviations_and_the_spring_in_one_per_cent(
    mode,
):
    plant = Plant.with_mode(mode)
    found = identified(plant, Run(highest_hz=1.5 * mode, seconds=5.0, noise=ENCODER), estimator="clsrivc")
    assert found.flexible.failure is None
    off = errors(found, plant)
    assert max(abs(deviations) for _, deviations in off.values()) < 3.0
    assert abs(off["stiffness"][0]) < 0.01
    # the position that is simulated under the recognised controller misses the encoder's noise alone
    assert found.flexible.held_out.position_rms == pytest.approx(ENCODER, rel=0.1)
    assert found.controller.accepted


def test_intervals_hold_the_truth_as_often_as_they_say():
    plant = Plant.with_mode(12.0)
    drawn = [
        errors(
            identified(plant, Run(highest_hz=18.0, seconds=3.0, noise=ENCODER, torque_noise=0.3, seed=seed)),
            plant,
        )
        for seed in range(8)
    ]
    deviations = np.array([[apart for _, apart in one.values()] for one in drawn])
    # 40 intervals of 95 %, of which those of one draw are not independent: 33 is five deviations down
    assert np.count_nonzero(np.abs(deviations) < 1.96) >= 33
    # and they are not too wide either
    assert 0.6 < np.sqrt(np.mean(deviations**2)) < 1.4


def test_friction_and_offset_of_the_motor_are_told_from_the_spring():
    plant = Plant.with_mode(25.0, coulomb=1.0, offset=0.5)
    found = identified(plant, Run(highest_hz=37.0, seconds=5.0, noise=ENCODER))
    assert abs(errors(found, plant)["stiffness"][0]) < 0.01
    assert found.flexible.parameters.at("coulomb")[0] == pytest.approx(1.0, abs=0.05)
    assert found.flexible.parameters.at("offset")[0] == pytest.approx(0.5, abs=0.02)


def test_gravity_acts_on_the_link_and_not_on_the_motor():
    plant = Plant.with_mode(12.0, gravity=20.0)
    log = log_of(recorded(plant, Run(highest_hz=18.0, seconds=5.0, noise=ENCODER)))
    found = identify_joint(robot_of(level=True), log, JointOptions(1), no_progress)
    # at the motor it would take 0.9 % off the link's inertia: g / k is 1 %
    off = errors(found, plant)
    assert abs(off["link_inertia"][0]) < 2e-3
    assert max(abs(deviations) for _, deviations in off.values()) < 3.5
    assert found.flexible.parameters.at("gravity_sine")[0] == pytest.approx(20.0, rel=5e-3)


def test_a_torque_that_is_taken_for_straight_between_samples_biases_the_joint(monkeypatch):
    plant = Plant.with_mode(40.0)
    signals = recorded(plant, Run(highest_hz=60.0, seconds=4.0))
    true_powers = responses.lower_powers

    def straight(denominator, series, step, hold):
        return true_powers(denominator, series, step, "first")

    monkeypatch.setattr(responses, "lower_powers", straight)  # of which all others are made
    wrong = identify_joint(robot_of(), log_of(signals), JointOptions(1), no_progress)
    share, deviations = errors(wrong, plant)["motor_inertia"]
    assert share > 0.01
    assert deviations > 3.0


def refused(plant: Plant, run: Run, **options: str) -> str:
    """Give why there is no flexible model, where a rigid one answers."""
    found = identified(plant, run, **options)
    assert found.rigid.failure is None
    assert isinstance(found.flexible.failure, (ExcitationError, SolverError))
    assert found.flexible.failure.remedy
    return found.flexible.failure.cause


@pytest.mark.parametrize("estimator", ["srivc", "clsrivc"])
@pytest.mark.parametrize("noise", [0.0, ENCODER])
def test_no_spring_is_seen_in_a_rigid_joint(noise, estimator):
    plant = Plant(stiffness=None, coulomb=1.0)
    run = Run(highest_hz=20.0, seconds=4.0, noise=noise)
    refused(plant, run, estimator=estimator)
    inertia, _ = identified(plant, run, order="rigid", estimator=estimator).rigid.parameters.at("inertia")
    assert inertia == pytest.approx(plant.inertia, rel=2e-3)


def test_a_mode_above_three_tenths_of_the_rate_is_refused():
    plant = Plant.with_mode(350.0)
    assert "above 0.3 times the rate" in refused(plant, Run(highest_hz=400.0, seconds=4.0, frequencies=60))


@pytest.mark.parametrize("estimator", ["srivc", "clsrivc"])
def test_a_mode_that_the_motion_does_not_reach_is_refused(estimator):
    plant = Plant.with_mode(25.0)
    found = identified(plant, Run(highest_hz=3.0, seconds=5.0, noise=ENCODER), estimator=estimator)
    assert found.flexible.failure is not None


def test_without_a_controller_the_closed_loop_is_refused_and_says_what_to_do():
    log = log_of(recorded(Plant(), Run(seconds=2.0)), reference=False)
    with pytest.raises(OptionError, match="clsrivc") as caught:
        identify_joint(robot_of(), log, JointOptions(1, "rigid", "clsrivc"), no_progress)
    assert "srivc" in caught.value.remedy
    assert "position_ref" in caught.value.remedy


def test_a_joint_that_stands_and_others_that_move_are_refused():
    log = log_of(recorded(Plant(), Run(seconds=2.0)), others=1)
    with pytest.raises(ExcitationError, match="joint 2 does not move"):
        identify_joint(robot_of(2), log, JointOptions(2), no_progress)
    assert identify_joint(robot_of(2), log, JointOptions(1, "rigid"), no_progress).rigid.order == "rigid"
    signals = recorded(Plant(), Run(seconds=2.0))
    both = np.column_stack([signals["position"], 0.3 * signals["position"]])
    moving = log_from_arrays("both", signals["time"], both, np.column_stack([signals["torque"]] * 2))
    with pytest.raises(ExcitationError, match="other joints move") as caught:
        identify_joint(robot_of(2), moving, JointOptions(1), no_progress)
    assert caught.value.evidence["moving"] == [2]


def test_a_torque_of_the_wrong_sign_is_refused():
    signals = recorded(Plant(stiffness=None), Run(seconds=3.0, highest_hz=5.0))
    with pytest.raises(ExcitationError, match=r"negative|not physically possible"):
        identify_joint(
            robot_of(),
            log_of(signals | {"torque": -signals["torque"]}),
            JointOptions(1, "rigid"),
            no_progress,
        )


@pytest.mark.parametrize(("highest_hz", "often"), [(20.0, True), (0.6, False)])
def test_friction_of_a_joint_that_reverses_often_is_doubted(highest_hz, often):
    run = Run(noise=2e-5, seconds=6.0, highest_hz=highest_hz, amplitude=0.6 if often else 2.0)
    log = log_of(recorded(Plant(stiffness=None, coulomb=5.0), run))
    document = model_joint(JointRequest(robot_of(), (log,), {"joint": 1, "order": "rigid"}))
    assert any("reverses often" in sentence for sentence in document["doubts"]) == often
