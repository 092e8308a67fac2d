"""Hold the set-up check: what is spoilt in a sound robot and its log is named, and nothing else is."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.conflicts.score import answer, mean_percent
from tests.conflicts.spoil import SPOILERS
from tests.core.conflicts.skew_arm import PLAIN, four_joints
from tests.core.estimate.worlds import swing, true_parameters
from tests.measured import measured_log, measured_robot
from tests.plant.cases import draw_clean
from tests.truths.cases import pendulum_robot
from veritorque.core.conflicts.registry import CONFLICTS
from veritorque.core.conflicts.samples import sampled
from veritorque.core.conflicts.search import find_conflicts
from veritorque.core.conflicts.setup import Setup
from veritorque.core.conflicts.trial import Trials
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.terms.kinematic_error import with_entry
from veritorque.core.errors import SolverError
from veritorque.core.identification.contradictions import has_impossible_joint
from veritorque.core.log.columns.assignment import Assignment, assigned
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.writing import to_description
from veritorque.core.setup_check import check_setup
from veritorque.core.signals.recipe import FilterOptions
from veritorque.core.signals.several import condition_all
from veritorque.core.signals.state import MotionState
from veritorque.core.study import IdentifyRequest, diagnose, identify, identify_in_full
from veritorque.core.validation.holdout import HoldOut


@pytest.fixture(scope="module")
def arm():
    """Give four skew joints with 1 % of noise, and what a sound study of them leaves."""
    robot = four_joints()
    model = standard_model(robot)
    truth = true_parameters(model, seed=3)
    state = swing(4, seed=5)
    torque = model.torque(truth, state)
    noise = 0.01 * np.sqrt(np.mean(torque**2, axis=0)) * np.random.default_rng(8).normal(size=torque.shape)
    log = log_from_arrays("swing", np.arange(len(torque)) / 100.0, state.position, torque + noise)
    return robot, log, mean_percent(identify(IdentifyRequest(robot, (log,), PLAIN)))


@pytest.mark.parametrize("way", sorted(SPOILERS))
def test_the_conflict_is_named_and_nothing_else(arm, way):
    robot, log, _ = arm
    found = answer(SPOILERS[way](robot, log, np.random.default_rng(16)))
    assert found.exact, found


def test_two_conflicts_are_named_one_after_the_other(arm):
    robot, log, sound = arm
    plain = Assignment.as_measured(4)
    spoilt = replace(plain, torque=plain.torque.scaled(-1.0, 1), position=plain.position.scaled(-1.0, 2))
    document = identify(IdentifyRequest(robot, (assigned(log, spoilt),), PLAIN))
    named = {(row["conflict"], *row["joints"]) for row in document["conflicts"]}
    assert named == {("torque_sign", 2), ("position_sign", 3)}
    assert mean_percent(document) < 1.05 * sound


@pytest.mark.parametrize(("scaled", "ratio", "reversed_"), [(1, 100.0, 2), (1, 49.0, 3), (2, 0.02, 1)])
def test_a_gear_ratio_is_found_as_exactly_beside_a_reversed_torque(arm, scaled, ratio, reversed_):
    """A wrong sign hides the ratio: a unit looks better at first, or the factor is off."""
    robot, log, sound = arm
    plain = Assignment.as_measured(4)
    spoilt = replace(plain, torque=plain.torque.scaled(1.0 / ratio, scaled).scaled(-1.0, reversed_))
    document = identify(IdentifyRequest(robot, (assigned(log, spoilt),), PLAIN))
    named = {(row["conflict"], *row["joints"]): row for row in document["conflicts"]}
    assert set(named) == {("gear_ratio", scaled + 1), ("torque_sign", reversed_ + 1)}
    assert min(row["confidence"] for row in named.values()) > 0.9
    scale = document["conflicts"][-1]["correction"]["mapping"]["torque"]["scale"]
    assert scale[scaled] == pytest.approx(1.0, rel=0.003), "beside what the assignment spoilt"
    assert mean_percent(document) < 1.05 * sound


def test_degrees_that_no_joint_could_turn_are_named_though_they_alone_make_the_fit_hardly_better():
    """A torque on the motor's side of a gear hides what the unit costs; the size of the numbers tells it."""
    case = draw_clean(4001, noise="none", robot="planar-2", duration=15.0)
    plain = Assignment.as_measured(2)
    spoilt = Assignment(plain.position.scaled(180.0 / np.pi, 1), plain.torque.scaled(0.01, 0))
    rows = whole_rows(assigned(case.log, spoilt))
    log = log_from_arrays("log", rows.time, rows.position, rows.torque)
    document = identify(IdentifyRequest(case.believed, (log,), PLAIN))
    named = [(row["conflict"], *row["joints"]) for row in document["conflicts"]]
    assert named[0] == ("unit", 2)
    assert named[1:] in ([("gear_ratio", 1)], [("gear_ratio", 2)])


def scara_swing(rate_hz):
    """Give a robot whose third joint slides, 20 s of motion (m and rad), and its torque with 1 % noise."""
    row = {"type": "revolute", "alpha": 0.0, "d": 0.0, "r": 0.0, "theta_offset": 0.0}
    joints = [row, {**row, "d": 0.35}, {**row, "type": "prismatic", "alpha": np.pi, "d": 0.3}, row]
    robot = robot_from_description({"name": "scara", "joints": joints})
    model, state = standard_model(robot), swing(4, seed=9, rate_hz=rate_hz)
    stroke = np.array([1.0, 1.0, 0.1, 1.0])
    state = MotionState(state.position * stroke, state.velocity * stroke, state.acceleration * stroke)
    torque = model.torque(true_parameters(model, seed=7), state)
    noise = np.random.default_rng(4).normal(size=torque.shape)
    return robot, state, torque + 0.01 * np.std(torque, axis=0) * noise


@pytest.mark.parametrize("reversed_", [False, True])
def test_a_slide_in_millimetres_is_named_and_not_its_force_in_another_unit(reversed_):
    """Its own equation is the same with a force a thousand times larger; the size of the stroke is not."""
    robot, state, torque = scara_swing(rate_hz=100.0)
    torque[:, 1] *= -1.0 if reversed_ else 1.0
    time = np.arange(len(torque)) / 100.0
    log = log_from_arrays("log", time, state.position * [1.0, 1.0, 1e3, 1.0], torque)
    document = identify(IdentifyRequest(robot, (log,), PLAIN))
    named = {(row["conflict"], *row["joints"], row["channel"]) for row in document["conflicts"]}
    assert named == {("unit", 3, "position")} | ({("torque_sign", 2, "torque")} if reversed_ else set())
    mapping = document["conflicts"][-1]["correction"]["mapping"]
    assert mapping["position"] == {
        "columns": ["q_1", "q_2", "q_3", "q_4"],
        "unit": ["rad", "rad", "mm", "rad"],
    }
    assert mapping["torque"]["unit"] == ["N m", "N m", "N", "N m"]


@pytest.mark.parametrize("conflicts", ["apply", "report"])
def test_a_fit_that_fails_because_of_a_conflict_names_it_and_is_done_again(conflicts):
    """A slide in mm and torques that are lost for 8 ms: the solver does not reach its accuracy."""
    robot, state, torque = scara_swing(rate_hz=500.0)
    torque[7000:7004] = 1e-3 * np.random.default_rng(5).normal(size=(4, 4))
    time = np.arange(len(torque)) / 500.0
    log = log_from_arrays("log", time, state.position * [1.0, 1.0, 1e3, 1.0], torque)
    request = IdentifyRequest(robot, (log,), PLAIN | {"conflicts": conflicts})
    if conflicts == "apply":
        (named,) = identify(request)["conflicts"]
        assert (named["conflict"], named["joints"], named["applied"]) == ("unit", [3], True)
        return
    with pytest.raises(SolverError) as failed:
        identify(request)
    assert failed.value.evidence["conflicts"] == ["the position of joint 3 is in mm"]
    assert "in mm" in failed.value.remedy


@pytest.mark.parametrize("factor", [180.0 / np.pi, np.pi / 180.0])
@pytest.mark.parametrize("swapped", [False, True])
def test_positions_that_are_all_in_another_unit_are_named_beside_channels_that_are_exchanged(
    arm, factor, swapped
):
    """Degrees taken for rad, and rad taken for degrees: what is to be pasted says the unit."""
    robot, log, sound = arm
    plain = Assignment.as_measured(4)
    spoilt = replace(plain, position=plain.position.scaled(factor, *range(4)))
    spoilt = replace(spoilt, torque=plain.torque.exchanged(1, 2)) if swapped else spoilt
    rows = whole_rows(assigned(log, spoilt))
    document = identify(
        IdentifyRequest(robot, (log_from_arrays("log", rows.time, rows.position, rows.torque),), PLAIN)
    )
    named = {(row["conflict"], *row["joints"]) for row in document["conflicts"]}
    assert named == {("unit", 1, 2, 3, 4)} | ({("channels_swapped", 2, 3)} if swapped else set())
    assert mean_percent(document) < 1.05 * sound
    assert not [defect for defect in document["defects"] if defect["kind"] == "implausible_unit"]
    if factor > 1.0:
        assert document["conflicts"][-1]["correction"]["mapping"]["position"]["unit"] == ["deg"] * 4


def test_a_measured_length_that_is_described_too_short_is_named_or_what_equals_it():
    pendulum, log = pendulum_robot(), measured_log("double_pendulum", "sys_id_2")
    setup = Setup(with_entry(pendulum, 2, "d", -0.1), Assignment.as_measured(2))
    motions = condition_all((log,), pendulum, FilterOptions(), blocks=20)
    trials = Trials(sampled(motions, HoldOut().chosen(1)))
    (found,) = CONFLICTS["link_length"].hypotheses(setup, trials)
    assert found.joints == (2,)
    assert found.setup.robot.links[1].row.d == pytest.approx(0.3, abs=0.04)
    (first,) = find_conflicts(setup, trials)
    assert first.hypothesis.conflict == "mounting"  # a planar arm tells the ratio of length and gravity alone
    assert [one.key for one in first.equivalents] == [("link_length", (2,), None)]
    described = Setup(pendulum, Assignment.as_measured(2))
    assert not list(CONFLICTS["link_length"].hypotheses(described, trials))


@pytest.mark.parametrize("wrong", [-0.1, 0.06, 0.0])
def test_a_length_is_named_where_the_description_gives_placements_as_a_urdf_does(arm, wrong):
    robot, log, sound = arm
    links = [replace(link, row=None) for link in robot.links]
    links[2] = replace(links[2], translation=links[2].translation + np.array([wrong, 0.0, 0.0]))
    document = check_setup(IdentifyRequest(replace(robot, links=tuple(links)), (log,), {}))
    assert [row["conflict"] for row in document["conflicts"]] == ["link_length"] * (wrong != 0.0)
    for row in document["conflicts"]:
        assert row["joints"] == [3]
        assert "along x of the frame of link 2, whose z is the axis of its joint" in row["statement"]
        described = row["correction"]["robot"]["joints"][2]["translation"]
        np.testing.assert_allclose(described, robot.links[2].translation, atol=0.01)
    assert mean_percent(document) < 1.05 * sound


@pytest.mark.parametrize(("degrees", "blocks"), [((9, -1), 40), ((0, 8), 20), ((5, 9), 40), ((-3, 5), 40)])
def test_nothing_is_named_in_the_place_of_a_slight_tilt_of_a_measured_arm(degrees, blocks):
    """Below the least angle a tilt is a cause. Its opposite may fit better, or the first torque in kN m."""
    robot, log = measured_robot("ur10e_open"), measured_log("ur10e_open", "fourier_30s_12h", 635, 3510)
    tilt = Rotation.from_rotvec(np.radians([*degrees, 0.0]))
    tilted = replace(robot, gravity=tilt.apply(robot.gravity))
    motions = condition_all((log,), tilted, FilterOptions(), blocks=blocks)
    trials = Trials(sampled(motions, HoldOut(0.25, blocks).chosen(1)))
    assert find_conflicts(Setup(tilted, trials.samples.as_measured), trials) == ()


@pytest.mark.parametrize("seed", [3, 6, 11])
def test_the_fewest_corrections_are_named_where_more_would_do_as_well(seed):
    """A sign beside another gravity: neither is found right beside the other's error."""
    row = {"type": "revolute", "alpha": 0.0, "d": 0.0, "r": 0.0, "theta_offset": 0.0}
    rows = [
        row,
        {**row, "alpha": -np.pi / 2, "d": 0.2},
        {**row, "type": "prismatic", "alpha": np.pi / 2, "d": 0.3},
    ]
    believed = robot_from_description({"name": "wall", "joints": rows})
    model, state = standard_model(replace(believed, gravity=np.array([0.0, -9.81, 0.0]))), swing(3, seed=seed)
    torque = model.torque(true_parameters(model, seed=seed), state) * [1.0, -1.0, 1.0]
    torque += 0.01 * np.std(torque, axis=0) * np.random.default_rng(seed).normal(size=torque.shape)
    log = log_from_arrays("wall", np.arange(len(torque)) / 100.0, state.position, torque)
    document = identify(IdentifyRequest(believed, (log,), PLAIN))
    named = sorted((one["conflict"], *one["joints"]) for one in document["conflicts"])
    assert named == [("mounting",), ("torque_sign", 2)]
    assert document["conflicts"][-1]["correction"]["robot"]["gravity"] == pytest.approx([0.0, -9.81, 0.0])


def test_a_robot_whose_table_is_in_the_standard_convention_is_read_so(arm):
    robot, log, sound = arm
    described = to_description(robot)
    joints = [dict(joint) for joint in described["joints"]]
    after = [*joints[1:], {"alpha": 0.0, "d": 0.0}]
    for joint, later in zip(joints, after, strict=True):  # the twist and length that a standard row ends with
        joint["alpha"], joint["d"] = later["alpha"], later["d"]
    wrong = robot_from_description(described | {"joints": joints})
    document = identify(IdentifyRequest(wrong, (log,), PLAIN))
    (found,) = document["conflicts"]
    assert found["conflict"] == "convention"
    assert mean_percent(document) < 1.05 * sound
    corrected = described | found["correction"]["robot"]
    assert identify(IdentifyRequest(robot_from_description(corrected), (log,), PLAIN))["conflicts"] == []


def test_a_unit_is_asked_for_where_numbers_are_unusual_though_the_fit_is_good():
    """On an arm that no gravity bends, inertias absorb most of a wrong unit."""
    case = draw_clean(1000, noise="white", robot="planar-2", duration=15.0)
    plain = Assignment.as_measured(2)
    spoilt = assigned(case.log, replace(plain, position=plain.position.scaled(180.0 / np.pi, 1)))
    rows = whole_rows(spoilt)
    log = log_from_arrays("degrees", rows.time, rows.position, rows.torque)
    (found,) = identify(IdentifyRequest(case.believed, (log,), PLAIN))["conflicts"]
    assert (found["conflict"], found["joints"]) == ("unit", [2])
    assert found["error_before_percent"] < 10.0


def test_of_two_torques_that_differ_by_a_thousand_the_one_of_an_unusual_size_is_in_another_unit():
    """The log alone tells their ratio only: either may be wrong."""
    case = draw_clean(64009, noise="white", robot="planar-2", duration=15.0)
    plain = Assignment.as_measured(2)
    rows = whole_rows(assigned(case.log, replace(plain, torque=plain.torque.scaled(1000.0, 1))))
    log = log_from_arrays("thousandths", rows.time, rows.position, rows.torque)
    (found,) = identify(IdentifyRequest(case.believed, (log,), PLAIN))["conflicts"]
    assert (found["conflict"], found["joints"]) == ("unit", [2])
    assert "mN m" in found["statement"]


def test_a_joint_that_only_impossible_bodies_follow_is_no_place_for_causes(arm):
    robot, log, _ = arm
    plain = Assignment.as_measured(4)
    geared = assigned(log, replace(plain, torque=plain.torque.scaled(1.0 / 50.0, 1)))
    as_logged = IdentifyRequest(robot, (geared,), PLAIN | {"conflicts": "report"})
    assert has_impossible_joint(identify_in_full(as_logged))
    assert not has_impossible_joint(identify_in_full(IdentifyRequest(robot, (log,), PLAIN)))


def test_a_study_of_what_was_corrected_is_that_of_what_was_right(arm):
    robot, log, _ = arm
    plain = Assignment.as_measured(4)
    spoilt = assigned(log, replace(plain, torque=plain.torque.exchanged(1, 2)))
    right, corrected = (
        identify(IdentifyRequest(robot, (one,), PLAIN))["base_parameters"] for one in (log, spoilt)
    )
    np.testing.assert_allclose(
        [row["value"] for row in corrected], [row["value"] for row in right], rtol=1e-9, atol=1e-12
    )


def test_a_conflict_that_is_only_reported_stays_open_and_no_cause_is_claimed(arm):
    robot, log, _ = arm
    plain = Assignment.as_measured(4)
    spoilt = assigned(log, replace(plain, torque=plain.torque.scaled(-1.0, 1)))
    document = diagnose(IdentifyRequest(robot, (spoilt,), PLAIN | {"conflicts": "report"}))
    (found,) = document["conflicts"]
    assert not found["applied"]
    assert document["doubts"][0].startswith("Robot and log disagree")
    assert document["diagnosis"]["verdict"] != "nothing_found"
    assert all(one["confidence"] <= 0.5 for one in document["diagnosis"]["findings"])


@pytest.fixture(scope="module")
def exchanged():
    """Give a planar arm with exchanged joints: other bodies explain all but 5 % of both torques."""
    case = draw_clean(1020, noise="white", robot="planar-2", duration=15.0)
    spoilt = SPOILERS["channels_swapped"](case.believed, case.log, np.random.default_rng(16))
    return IdentifyRequest(spoilt.robot, (spoilt.log,), PLAIN)


def test_a_diagnosis_doubts_the_set_up_before_it_names_a_cause(exchanged):
    document = diagnose(exchanged)
    (found,) = document["conflicts"]
    assert found["statement"] == "the channels of joints 1 and 2 are exchanged"
    assert found["applied"]
    assert document["diagnosis"]["verdict"] == "nothing_found"
    assert document["diagnosis"]["findings"] == []


def test_whoever_asks_for_a_check_doubts_the_set_up(exchanged):
    (found,) = check_setup(exchanged)["conflicts"]
    assert found["statement"] == "the channels of joints 1 and 2 are exchanged"
    assert identify(exchanged)["conflicts"] == []  # its fit gives no reason to ask


def test_a_log_that_its_model_explains_is_not_examined(arm, monkeypatch):
    robot, log, _ = arm

    def refuse(*_):
        raise AssertionError("examined")

    monkeypatch.setattr("veritorque.core.conflicts.doubted.find_conflicts", refuse)
    assert identify(IdentifyRequest(robot, (log,), PLAIN))["conflicts"] == []


@pytest.mark.parametrize("seed", [1, 2])
def test_no_correction_is_more_likely_than_not_while_the_model_fails_on_a_joint(arm, seed):
    """Torques of another run are those of no corrected robot."""
    robot, log, _ = arm
    rows, other = whole_rows(log), swing(4, seed=50 + seed)
    model = standard_model(robot)
    torque = model.torque(true_parameters(model, seed=3), other)[: len(rows.time)]
    strange = log_from_arrays("strange", rows.time, rows.position, torque)
    document = check_setup(IdentifyRequest(robot, (strange,), {}))
    assert document["agreement"] == "doubtful"
    assert max((row["confidence"] for row in document["conflicts"]), default=0.0) <= 0.5


@pytest.mark.parametrize("name", sorted(CONFLICTS))
def test_every_hypothesis_is_another_set_up_and_says_what_to_do(arm, name):
    robot, log, _ = arm
    motions = condition_all((log,), robot, FilterOptions(), blocks=20)
    trials = Trials(sampled(motions, HoldOut().chosen(1)))
    setup = Setup(robot, trials.samples.as_measured)
    listed = list(CONFLICTS[name].hypotheses(setup, trials))
    assert listed or name in {"mounting", "link_length", "gear_ratio", "other_signal", "zero_offset"}
    for one in listed:
        other = one.setup
        assert (
            other.assignment != setup.assignment
            or other.robot.links is not robot.links
            or not np.array_equal(other.robot.gravity, robot.gravity)
        )
        assert one.conflict == name
        assert one.statement
        assert one.remedy
        assert set(one.joints) <= {1, 2, 3, 4}


@pytest.mark.parametrize("unit", [1.0, 1e-3])
def test_sound_measured_robots_have_no_conflict(unit):
    """Described bodies say nothing of it: with kN m on all joints one joint alone seemed to be in kN m."""
    robot, log = measured_robot("ur10e_open"), measured_log("ur10e_open", "fourier_30s_12h")
    rows = whole_rows(log)
    log = log_from_arrays(log.name, rows.time, rows.position, unit * rows.torque)
    motions = condition_all((log,), robot, FilterOptions(), blocks=20)
    trials = Trials(sampled(motions, HoldOut().chosen(1)))
    assert find_conflicts(Setup(robot, trials.samples.as_measured), trials) == ()


@pytest.mark.parametrize("way", ["channels_swapped", "mounting", "motor_side"])
def test_a_conflict_on_a_measured_robot_is_named(way):
    robot, log = measured_robot("ur10e_open"), measured_log("ur10e_open", "fourier_30s_12h")
    spoilt = SPOILERS[way](robot, log, np.random.default_rng(4))
    assert answer(spoilt).exact
