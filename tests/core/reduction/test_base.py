"""Base parameters against numerical rank, against the law they rest on, and against robots done by hand."""

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tools import pinocchio_model, random_bodies, random_motion, random_robot, with_mimics
from veritorque.core.dynamics.model import DynamicModel, standard_model
from veritorque.core.reduction.base import BaseModel, base_model
from veritorque.core.regressor.columns import ColumnPlan, all_columns, dense
from veritorque.core.robot.builtin import builtin_robot
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.frames import rotation_rpy
from veritorque.core.robot.model import Joint, Link, RobotModel
from veritorque.core.signals.state import MotionState

INERTIAL = ("rigid_body", "rotor_inertia")
LEVEL, SIDEWAYS = (0.0, 0.0, -9.81), (0.0, -9.81, 0.0)


def _state(rng: np.random.Generator, joints: int, samples: int) -> MotionState:
    motion = random_motion(rng, joints, samples)
    return MotionState(motion.position, motion.velocity, motion.acceleration)


def _robot(kinds: str, *rotations: np.ndarray, gravity: tuple[float, ...] = LEVEL) -> RobotModel:
    """Make a chain of joints (R or P), each turned on the one before, all at one point."""
    parts = tuple(
        Link(
            f"link_{number}",
            "prismatic" if kind == "P" else "revolute",
            number - 1,
            number,
            turn,
            np.zeros(3),
        )
        for number, (kind, turn) in enumerate(zip(kinds, rotations, strict=True), start=1)
    )
    joints = tuple(Joint(f"joint_{number}", friction=()) for number in range(1, len(kinds) + 1))
    return RobotModel("by hand", parts, joints, np.array(gravity))


def _words(base: BaseModel) -> dict[str, str]:
    return {name: base.in_words(row) for row, name in enumerate(base.names)}


@pytest.mark.parametrize(
    ("robot", "standard", "inertial", "everything"),
    [("yumi-left", 77, 50, 71), ("yumi-right", 77, 50, 71), ("yumi", 154, 100, 142)],
)
def test_yumi_has_the_base_parameters_that_the_seed_counts(robot, standard, inertial, everything):
    # The seed: 77 -> 50, and 98 -> 71 with friction and offset. Two arms share no moving link: twice that.
    model = standard_model(builtin_robot(robot), INERTIAL)
    assert len(model.parameters) == standard
    assert len(base_model(model).kept) == inertial
    assert len(base_model(standard_model(builtin_robot(robot))).kept) == everything


def test_a_yumi_arm_on_a_level_base_has_two_fewer():
    arm = builtin_robot("yumi-left")
    level = RobotModel(arm.name, arm.links, arm.joints, np.array(LEVEL))
    assert len(base_model(standard_model(level, INERTIAL)).kept) == 48
    assert len(base_model(standard_model(level)).kept) == 69


@pytest.mark.parametrize("robot", ["yumi-left", "yumi"])
def test_the_count_is_the_rank_of_pinocchios_regressor(robot):
    model = standard_model(builtin_robot(robot), ("rigid_body",))
    joints = len(model.robot.joints)
    rng = np.random.default_rng(1)
    engine = pinocchio_model(model.robot, random_bodies(rng, joints))
    data, state = engine.createData(), _state(rng, joints, 60)
    rows = [
        np.hstack([pin.computeJointTorqueRegressor(engine, data, q, dq, ddq), np.diag(ddq)])
        for q, dq, ddq in zip(state.position, state.velocity, state.acceleration, strict=True)
    ]
    stacked = np.vstack(rows)
    scale = np.linalg.norm(stacked, axis=0)
    values = np.linalg.svd(stacked / np.maximum(scale, 1e-9), compute_uv=False)
    count = len(base_model(standard_model(model.robot, INERTIAL)).kept)
    assert values[count - 1] > 1e-6 * values[0]
    assert values[count] < 1e-12 * values[0]


@given(st.integers(0, 2**32 - 1), st.integers(1, 7), st.booleans(), st.sampled_from([0.0, 0.4, 1.0]))
def test_grouped_parameters_give_the_torque_of_all_parameters(seed, links, tree, prismatic):
    rng = np.random.default_rng(seed)
    robot = with_mimics(random_robot(rng, links, tree=tree, prismatic=prismatic), rng)
    base = base_model(standard_model(robot))
    state = _state(rng, len(robot.joints), 30)
    W, W_base = dense(all_columns(base.model), state), dense(ColumnPlan(base.model, base.kept), state)
    assert np.max(np.abs(W_base @ base.grouping - W)) < 1e-8 * np.abs(W).max()


@given(st.integers(0, 2**32 - 1), st.integers(1, 7), st.booleans())
def test_base_columns_are_independent(seed, links, tree):
    rng = np.random.default_rng(seed)
    base = base_model(standard_model(random_robot(rng, links, tree=tree)))
    W = dense(ColumnPlan(base.model, base.kept), _state(rng, links, 100))
    assert np.linalg.matrix_rank(W / np.linalg.norm(W, axis=0), tol=1e-9) == len(base.kept)


def test_relabelling_the_joints_relabels_the_base_parameters():
    rng = np.random.default_rng(2)
    branches = random_robot(rng, 3), random_robot(rng, 4)
    new_number = {1: 5, 2: 6, 3: 7, 4: 1, 5: 2, 6: 3, 7: 4}
    names, found = (_names(_side_by_side(*both)) for both in (branches, branches[::-1]))
    assert {(symbol, new_number[number]) for symbol, number in names} == found


def _side_by_side(one: RobotModel, other: RobotModel) -> RobotModel:
    """Stand two chains on the same base."""
    shift = len(one.links)
    moved = tuple(
        Link(
            link.name,
            link.kind,
            link.antecedent and link.antecedent + shift,
            link.joint + shift,
            link.rotation,
            link.translation,
        )
        for link in other.links
    )
    return RobotModel("both", one.links + moved, one.joints + other.joints, np.array(SIDEWAYS))


def _names(robot: RobotModel) -> set[tuple[str, int]]:
    base = base_model(standard_model(robot))
    return {(name.rstrip("0123456789"), base.parameter(row).number) for row, name in enumerate(base.names)}


def test_a_pendulum_about_a_horizontal_axis_shows_its_inertia_and_its_first_moments():
    base = base_model(standard_model(_robot("R", np.eye(3), gravity=SIDEWAYS)))
    assert _words(base) == {"ZZR1": "ZZ1 + IA1", "MX1": "MX1", "MY1": "MY1"}


def test_a_turntable_shows_its_inertia_alone():
    base = base_model(standard_model(_robot("R", np.eye(3))))
    assert _words(base) == {"ZZR1": "ZZ1 + IA1"}
    assert [base.model.parameters[one].name for one in base.without_effect] == [
        "XX1", "XY1", "XZ1", "YY1", "YZ1", "MX1", "MY1", "MZ1", "M1",
    ]  # fmt: skip  # a table


def test_a_lift_tells_its_mass_from_its_rotor_and_a_sledge_does_not():
    assert _words(base_model(standard_model(_robot("P", np.eye(3))))) == {"M1": "M1", "IA1": "IA1"}
    sledge = base_model(standard_model(_robot("P", np.eye(3), gravity=SIDEWAYS)))
    assert _words(sledge) == {"MR1": "M1 + IA1"}


def test_a_gantry_shows_the_masses_that_each_axis_moves():
    # By hand: axis 1 moves M1 + M2 + M3 and its rotor, axis 2 M2 + M3, the lift M3. Only the lift feels
    # gravity, so only there the rotor is distinguished. With base values m1, m2 the torques are
    # (m1 + m2 + M3) q1'' and (m2 + M3) q2'', hence m2 = M2 + IA2 and m1 = M1 + IA1 - IA2.
    first, turn = rotation_rpy(0.0, np.pi / 2, 0.0), rotation_rpy(0.0, np.pi / 2, np.pi / 2)
    axis_1, axis_2, axis_3 = first[:, 2], (first @ turn)[:, 2], (first @ turn @ turn)[:, 2]
    assert np.allclose(np.abs([axis_1, axis_2, axis_3]), np.eye(3)[[0, 1, 2]], atol=1e-12)
    assert _words(base_model(standard_model(_robot("PPP", first, turn, turn)))) == {
        "MR1": "M1 + IA1 - IA2",
        "MR2": "M2 + IA2",
        "M3": "M3",
        "IA3": "IA3",
    }


def test_two_parallel_axes_group_as_the_textbook_says():
    # A planar arm on a level base: the tip carries M2 on a radius of 0.5 m about the first axis.
    base = base_model(standard_model(_planar(0.5)))
    assert _words(base) == {
        "ZZR1": "ZZ1 + 0.25 M2 + IA1",
        "ZZ2": "ZZ2",
        "MX2": "MX2",
        "MY2": "MY2",
        "IA2": "IA2",
    }


def _planar(length: float) -> RobotModel:
    places = (np.zeros(3), np.array([length, 0.0, 0.0]))
    parts = tuple(
        Link(f"link_{number}", "revolute", number - 1, number, np.eye(3), place)
        for number, place in enumerate(places, start=1)
    )
    return RobotModel("planar", parts, (Joint("a", friction=()), Joint("b", friction=())), np.array(LEVEL))


def test_every_standard_parameter_is_told_how_far_it_can_be_known():
    base = base_model(standard_model(_planar(0.5)))
    told = {one.name: base.identifiability(column) for column, one in enumerate(base.model.parameters)}
    individually = {"ZZ2", "MX2", "MY2", "IA2"}
    combined = {"ZZ1", "IA1", "M2"}
    assert {name for name, word in told.items() if word == "individually"} == individually
    assert {name for name, word in told.items() if word == "in_combination"} == combined
    assert {word for name, word in told.items() if name not in individually | combined} == {"no"}


def test_base_values_are_the_sums_that_the_words_say():
    base = base_model(standard_model(_planar(0.5)))
    standard = np.arange(1.0, 1.0 + len(base.model.parameters))
    value = dict(zip((one.name for one in base.model.parameters), standard, strict=True))
    found = dict(zip(base.names, base.base_of(standard), strict=True))
    assert found["ZZR1"] == pytest.approx(value["ZZ1"] + value["IA1"] + 0.25 * value["M2"])


def test_friction_groups_with_nothing():
    base = base_model(standard_model(builtin_robot("yumi-left")))
    for row, name in enumerate(base.names):
        if base.parameter(row).symbol in {"FV", "FC", "OFF"}:
            assert base.relation(row) == {name: 1.0}


def test_the_same_robot_gives_the_same_numbers_every_time():
    def found() -> tuple[tuple[str, ...], bytes]:
        base = base_model(_arm())
        return base.names, base.grouping.tobytes()

    assert found() == found()


def _arm() -> DynamicModel:
    return standard_model(builtin_robot("yumi-left"), INERTIAL)


def _six_axes(quarter: float, *, zeros: float = 0.0, off: tuple[float, ...] = (0.0,) * 6) -> DynamicModel:
    """Make a six-axis arm whose right angles, joint zeros and calibration (rad) are given."""
    twists = (0.0, -quarter, 0.0, quarter, -quarter, quarter)
    lengths = zip((0, 0, 0.42, 0.03, 0, 0), (0.3, 0.1, 0, 0.4, 0, 0.1), strict=True)
    rows = [
        {"type": "revolute", "alpha": twist + extra, "d": d, "r": r, "theta_offset": zeros}
        for twist, extra, (d, r) in zip(twists, off, lengths, strict=True)
    ]
    return standard_model(robot_from_description({"name": "arm", "joints": rows}))


def _count(model: DynamicModel) -> int:
    return len(base_model(model).kept)


def test_a_right_angle_written_with_five_digits_is_still_a_right_angle():
    exact, rounded = (base_model(_six_axes(angle)) for angle in (np.pi / 2, 1.5708))
    assert rounded.names == exact.names
    assert np.array_equal(rounded.grouping, exact.grouping)
    assert len(exact.kept) == 58
    assert _count(_six_axes(1.6)) > 58


def test_twists_off_by_milliradians_are_taken_as_written_and_joint_zeros_change_no_rank():
    # By the rank of pinocchio's regressor: 1.57 leaves one axis just off the vertical.
    assert _count(_six_axes(1.57)) == 59
    assert _count(_six_axes(np.pi / 2, zeros=0.003)) == 58
    calibrated = base_model(_six_axes(np.pi / 2, off=(0.0004, 0.0003, 0.0006, -0.0004, 0.0002, 0.0005)))
    assert len(calibrated.kept) == 61
    assert 1e-5 < calibrated.rank["least_share_kept"] < 1e-3
