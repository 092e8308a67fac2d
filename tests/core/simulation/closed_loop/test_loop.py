"""The compiled loop: its rows obey the inverse dynamics, pieces join, and other schemes and engines agree."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from scipy.interpolate import CubicHermiteSpline

from tests.core.simulation.worlds import block, mechanism, pendulum, slope
from tests.plant.robots import draw_arm
from tests.tools import pinocchio_model, random_bodies, random_robot, relative_difference
from veritorque.core.dynamics.model import DynamicModel, standard_model
from veritorque.core.dynamics.terms.friction_stribeck import Stribeck
from veritorque.core.dynamics.terms.joint_coupling import MissingCoupling
from veritorque.core.errors import OptionError, SolverError
from veritorque.core.robot.model import Coupling
from veritorque.core.signals.state import MotionState
from veritorque.core.simulation.closed_loop.loop import Loop, LoopState, Played
from veritorque.core.simulation.control.control_law import ControlLaw, Gains, Inputs
from veritorque.core.simulation.control.controller import ControllerModel
from veritorque.core.simulation.drive import Drive, Feedback
from veritorque.core.simulation.mechanism import Mechanism, mechanism_of
from veritorque.core.simulation.rollout import rollout
from veritorque.core.simulation.stage import States, accelerations

STEP = 2e-3
ROWS = 1500
FINE = 16
"""Steps of a fine rollout per sample."""
WORLDS = ("staubli-tx40", "planar-3", "slide")


def world(name: str) -> Mechanism:
    if name == "slide":
        return slope(IA=0.4, FV=3.0, FC=6.0, OFF=-0.7)
    arm = draw_arm(name, np.random.default_rng(5))
    model = standard_model(arm.robot)
    drives = {"IA": arm.rotor_inertia, "FV": arm.viscous, "FC": arm.coulomb, "OFF": arm.offset}
    motors = dict(zip(("IAM", "FVM", "FCM"), arm.motors.T, strict=True)) if len(arm.motors) else {}
    values = np.empty(len(model.parameters))
    values[: arm.bodies.size] = arm.bodies.ravel()
    for place, parameter in enumerate(model.parameters[arm.bodies.size :], start=arm.bodies.size):
        if parameter.symbol in motors:
            values[place] = motors[parameter.symbol][0]
        else:
            values[place] = drives[parameter.symbol][parameter.joint - 1]
    return mechanism_of(model, values)


def wanted(joints: int, *, step: float = STEP, samples: int = ROWS, speed: float = 1.0) -> MotionState:
    """Swing every joint so slowly that it sticks at its reversals."""
    rng = np.random.default_rng(6)
    time = step * np.arange(samples)
    rate, phase = speed * rng.uniform(2.0, 5.0, joints), rng.uniform(0.0, 6.0, joints)
    angle = time[:, None] * rate + phase
    return MotionState(0.4 * np.sin(angle), 0.4 * rate * np.cos(angle), -0.4 * rate**2 * np.sin(angle), time)


def followed(
    machine: Mechanism, motion: MotionState, *, step: float = STEP, substeps: int = 1
) -> tuple[Loop, LoopState, Inputs]:
    """Let a soft controller follow a motion with nothing fed forward but gravity."""
    inertia = np.diag(machine.mass_matrices(motion.position[:1])[0])
    gains = Gains(inertia * 20.0**2, 2.0 * inertia * 20.0)
    still = np.zeros_like(motion.position)
    feed = machine.torque(MotionState(motion.position, still, still))
    loop = Loop(machine, ControlLaw.of_joints(gains), step, substeps)
    return loop, loop.start(motion), Inputs(feed, motion.position, motion.velocity)


def played_along(machine: Mechanism, motion: MotionState) -> Played:
    loop, start, inputs = followed(machine, motion)
    return loop.run(start, inputs)[0]


def asked(loop: Loop, inputs: Inputs, played: Played) -> np.ndarray:
    """Give the torque of a joint controller at the played rows."""
    gains = loop.law.table
    error, slip = inputs.position - played.state.position, inputs.velocity - played.state.velocity
    return np.asarray(inputs.feed_forward + gains[0] * error + gains[1] * slip)


def cut(inputs: Inputs, rows: slice) -> Inputs:
    return Inputs(**{name: part[rows] for name, part in vars(inputs).items()})


@pytest.mark.parametrize("substeps", [1, 3])
@pytest.mark.parametrize("name", WORLDS)
def test_the_inverse_dynamics_hold_at_every_row_with_the_share_of_friction_in_the_place_of_the_sign(
    name, substeps
):
    machine = world(name)
    loop, start, inputs = followed(machine, wanted(machine.joints), substeps=substeps)
    played, _ = loop.run(start, inputs)
    model, parameters = machine.model, machine.parameters
    share = played.state.friction_share
    assert share.shape[1] == machine.joints + len(machine.robot.couplings)
    assert np.all((np.abs(share) < 1.0).any(axis=0)), "every friction sticks somewhere"
    assert relative_difference(model.torque(parameters, played.state), played.torque) < 1e-12
    widths = {"coulomb": (0.3,) * machine.joints, "coupling": (0.3,) * len(machine.robot.couplings)}
    smooth = DynamicModel(
        model.robot,
        tuple(
            replace(term, widths=widths[term.name]) if term.name in widths else term for term in model.terms
        ),
    )
    assert relative_difference(smooth.torque(parameters, played.state), played.torque) < 1e-12
    signs = model.torque(parameters, replace(played.state, friction_share=None))
    assert relative_difference(signs, played.torque) > 1e-3


@pytest.mark.parametrize("substeps", [1, 3])
def test_a_mass_under_a_sampled_controller_moves_as_it_exactly_does_where_its_torque_is_held(substeps):
    machine, step = slope(IA=0.4), 0.01
    at_rest = MotionState(*np.zeros((3, 1, 1)))
    mass, weight = machine.mass_matrices(at_rest.position)[0, 0, 0], machine.torque(at_rest)[0, 0]
    model = ControllerModel("pd", kp=(30.0,), kd=(2.0,), velocity="backward")
    loop = Loop(machine, model.law(step), step, substeps)
    played, _ = loop.run(loop.start(at_rest), model.inputs(step, np.full((300, 1), 0.2)))
    place = played.state.position[:, 0]
    held = 30.0 * (0.2 - place[1:]) - 2.0 * np.diff(place) / step
    acceleration = (held - weight) / mass
    expected = 0.5 * step**2 * (acceleration[:-1] + acceleration[1:])
    np.testing.assert_allclose(np.diff(place[1:], 2), expected[:-1], atol=1e-13)
    assert np.ptp(acceleration) > 1.0


@pytest.mark.parametrize("name", WORLDS)
def test_the_torque_is_the_controllers_but_for_a_bias_foreseen_in_second_order(name):
    machine, gaps = world(name), []
    for refined in (1, 2):
        step = STEP / refined
        loop, start, inputs = followed(
            machine, wanted(machine.joints, step=step, samples=400 * refined), step=step
        )
        played, _ = loop.run(start, inputs)
        gaps.append(np.median(np.abs(asked(loop, inputs, played) - played.torque).max(axis=1)))
    assert gaps[0] < 1e-3 * np.abs(played.torque).max()
    assert gaps[1] < max(gaps[0] / 3.0, 1e-12)


@pytest.mark.parametrize("substeps", [1, 2])
@pytest.mark.parametrize("name", WORLDS)
def test_a_motion_cut_into_pieces_gives_equal_bytes(name, substeps):
    machine = world(name)
    loop, start, inputs = followed(machine, wanted(machine.joints), substeps=substeps)
    whole, end = loop.run(start, inputs)
    state, pieces = start, []
    for rows in (slice(0, 1), slice(1, 700), slice(700, None)):
        piece, state = loop.run(state, cut(inputs, rows))
        pieces.append(piece)
    for part in ("position", "velocity", "acceleration", "time", "friction_share"):
        joined = np.concatenate([getattr(piece.state, part) for piece in pieces])
        assert joined.tobytes() == getattr(whole.state, part).tobytes()
    assert np.concatenate([piece.torque for piece in pieces]).tobytes() == whole.torque.tobytes()
    assert state.table.tobytes() == end.table.tobytes()


def errors_against_rollout(machine: Mechanism, refinements: tuple[int, ...]) -> np.ndarray:
    """Give the RMS distance of positions to a fine rollout under the same inputs, per number of substeps."""
    motion = wanted(machine.joints, samples=300)
    loop, _, inputs = followed(machine, motion)
    time = np.arange(len(motion.position))
    often = np.linspace(0.0, time[-1], FINE * time[-1] + 1)
    way = CubicHermiteSpline(time, inputs.position, STEP * inputs.velocity)
    feed = np.column_stack([np.interp(often, time, series) for series in inputs.feed_forward.T])
    back = Feedback(
        loop.law.table[0], loop.law.table[1], way(often)[:, :, None], way(often, 1)[:, :, None] / STEP
    )
    first = motion.at(slice(0, 1))
    drive = Drive(STEP / FINE, feed[:, :, None], back)
    true = rollout(machine, States.starting(machine, first), drive, longest_step=STEP / FINE)
    began = accelerations(machine, first, true.torque[:1, :, 0])
    found = []
    for substeps in refinements:
        fine = replace(loop, substeps=substeps)
        played, _ = fine.run(fine.start(replace(first, acceleration=began)), inputs)
        found.append(np.sqrt(np.mean((played.state.position - true.position[::FINE, :, 0]) ** 2)))
    return np.array(found)


@pytest.mark.parametrize("dry", [True, False], ids=["dry friction", "none"])
@pytest.mark.parametrize("name", WORLDS)
def test_it_converges_to_the_rollout_in_second_order_and_agrees_with_it(name, dry):
    machine = world(name)
    if not dry:
        weights, levels, frictions = machine.weights[:0], machine.levels[:0], machine.frictions[:0]
        machine = replace(machine, weights=weights, levels=levels, frictions=frictions)
    errors = errors_against_rollout(machine, (1, 2, 4))
    assert errors[0] < 1e-4
    assert np.all(errors[1:] < errors[:-1] / 3.5)


def test_its_accelerations_are_pinocchios_under_its_torque_and_friction():
    rng = np.random.default_rng(7)
    robot, bodies = random_robot(rng, 7), random_bodies(rng, 7)
    machine = mechanism(robot, bodies, IA=0.2, FV=1.5, FC=2.0, OFF=0.3)
    loop, start, inputs = followed(machine, wanted(7))
    played, _ = loop.run(start, inputs)
    state, model = played.state, pinocchio_model(robot, bodies)
    model.armature = np.full(7, 0.2)
    data = model.createData()
    left = played.torque - 1.5 * state.velocity - 2.0 * state.friction_share - 0.3
    rows = zip(state.position, state.velocity, left, strict=True)
    expected = np.array([pin.aba(model, data, *row).copy() for row in rows])
    assert relative_difference(state.acceleration, expected) < 1e-9


@pytest.mark.parametrize("joint", [0, 2])
def test_a_joint_that_friction_holds_stays_at_rest_to_the_bit(joint):
    machine = world("planar-3")
    position = np.array([[0.4, -0.7, 0.9]])
    still = np.zeros_like(position)
    weight = machine.torque(MotionState(position, still, still))
    feed = np.repeat(weight, 200, axis=0)
    feed[:, joint] += 0.5 * machine.levels[joint] * np.sin(np.linspace(0.0, 9.0, 200))
    none = np.zeros_like(feed)
    loop = Loop(machine, ControlLaw.of_joints(Gains(np.zeros(3), np.zeros(3))), STEP)
    played, _ = loop.run(loop.start(MotionState(position, still, still)), Inputs(feed, none, none))
    assert np.array_equal(played.state.position, np.repeat(position, 200, axis=0))
    assert not played.state.velocity.any()
    assert not played.state.acceleration.any()
    assert np.all(np.abs(played.state.friction_share) < 1.0)
    expected = (feed - weight)[:, joint] / machine.levels[joint]
    np.testing.assert_allclose(played.state.friction_share[:, joint], expected, atol=1e-12)


def test_without_a_drive_energy_falls_until_all_is_at_rest():
    machine, step = world("planar-3"), 1e-3
    arm = draw_arm("planar-3", np.random.default_rng(5))
    model = pinocchio_model(arm.robot, arm.bodies)
    model.armature = arm.rotor_inertia.copy()
    data = model.createData()
    start = MotionState(*(np.array([row]) for row in ([0.9, -0.4, 0.7], [1.0, -2.0, 1.5], [0.0] * 3)))
    force = machine.offset[None].repeat(4000, axis=0)
    start = replace(start, acceleration=accelerations(machine, start, force[:1]))
    loop = Loop(machine, ControlLaw.of_joints(Gains(np.zeros(3), np.zeros(3))), step)
    played, _ = loop.run(loop.start(start), Inputs(force, 0.0 * force, 0.0 * force))
    state = played.state
    energy = np.array(
        [
            pin.computeKineticEnergy(model, data, q, v) + pin.computePotentialEnergy(model, data, q)
            for q, v in zip(state.position, state.velocity, strict=True)
        ]
    )
    assert np.diff(energy).max() < 1e-6 * np.ptp(energy)
    assert energy[0] - energy[-1] > 1.0
    assert not state.velocity[-1].any()


def test_joints_may_be_numbered_in_another_order():
    rng = np.random.default_rng(8)
    robot, bodies = random_robot(rng, 5, tree=True), random_bodies(rng, 5)
    robot = replace(robot, couplings=(Coupling("gear", 1, (2, 4), (1.0, -0.5)),))
    order = np.array([3, 0, 4, 1, 2])  # the new number of each joint
    moved = replace(
        robot,
        links=tuple(replace(link, joint=int(order[link.joint - 1]) + 1) for link in robot.links),
        joints=tuple(robot.joints[old] for old in np.argsort(order)),
        couplings=(Coupling("gear", 1, (int(order[1]) + 1, int(order[3]) + 1), (1.0, -0.5)),),
    )
    drives = {"IA": 0.3, "FV": 1.0, "FC": 2.0, "IAM": 0.1, "FVM": 0.5, "FCM": 1.5}
    motion = wanted(5, samples=500)
    back = np.argsort(order)
    turned = MotionState(*(part[:, back] for part in (motion.position, motion.velocity, motion.acceleration)))
    one, other = (
        played_along(mechanism(body, bodies, **drives), of) for body, of in ((robot, motion), (moved, turned))
    )
    assert relative_difference(other.state.position[:, order], one.state.position) < 1e-9
    assert relative_difference(other.torque[:, order], one.torque) < 1e-7
    columns = [*order, 5]
    np.testing.assert_allclose(other.state.friction_share[:, columns], one.state.friction_share, atol=1e-6)


@pytest.mark.parametrize("stiff", [1e2, 1e4, 1e6])
def test_no_damping_of_a_light_joint_makes_it_unstable(stiff):
    # damping times the step is up to two million times the wrist's inertia
    arm = draw_arm("staubli-tx40", np.random.default_rng(5))
    model = standard_model(arm.robot, ("rigid_body", "viscous"))
    values = np.concatenate([arm.bodies.ravel(), np.full(6, stiff)])
    machine = mechanism_of(model, values)
    motion = wanted(6)
    loop = Loop(machine, ControlLaw.of_joints(Gains(np.full(6, 100.0), np.full(6, stiff))), STEP)
    off = replace(motion, velocity=motion.velocity + 0.5)
    played, _ = loop.run(loop.start(off), Inputs(np.zeros((ROWS, 6)), motion.position, motion.velocity))
    assert np.abs(played.state.velocity).max() < 2.0 * np.abs(motion.velocity).max() + 0.5
    assert relative_difference(machine.torque(played.state), played.torque) < 1e-12


def test_a_joint_without_a_level_shares_the_sign_of_its_speed():
    machine = pendulum(FV=0.1)
    loop, start, inputs = followed(machine, wanted(1))
    played, _ = loop.run(start, inputs)
    assert np.array_equal(played.state.friction_share, np.sign(played.state.velocity))


def test_an_undeclared_coupling_takes_no_share_of_a_declared_one():
    robot = draw_arm("staubli-tx40", np.random.default_rng(5)).robot
    term, motion = MissingCoupling(Coupling("missed", 2, (2, 3), (1.0, 1.0))), wanted(6, samples=50)
    known = replace(motion, friction_share=np.zeros((50, 7)))
    assert np.array_equal(term.series(robot, known), term.series(robot, motion))


def test_terms_that_the_loop_does_not_compile_are_refused_by_name():
    machine = block(FC=1.0)
    model, extra = machine.model, Stribeck(1, 0.1)
    more = mechanism_of(DynamicModel(model.robot, (*model.terms, extra)), np.append(machine.parameters, 0.5))
    gains = ControlLaw.of_joints(Gains(np.zeros(1), np.zeros(1)))
    with pytest.raises(OptionError, match="does not simulate all terms") as refused:
        Loop(more, gains, STEP)
    assert refused.value.evidence["terms"] == [extra.name]
    with pytest.raises(OptionError, match="clock"):
        Loop(machine, gains, STEP, 0)


def test_a_robot_that_cannot_be_accelerated_is_refused_with_its_joint():
    machine = mechanism(random_robot(np.random.default_rng(9), 3), random_bodies(np.random.default_rng(9), 3))
    bodies = machine.parameters.copy()
    bodies[20:30] *= -5.0
    loop, start, inputs = followed(mechanism_of(machine.model, bodies), wanted(3))
    with pytest.raises(SolverError, match="not positive definite") as refused:
        loop.run(start, inputs)
    assert refused.value.evidence["time"] == 0.0
    assert 1 <= refused.value.evidence["joint"] <= 3


def test_a_motion_that_diverges_is_refused_with_its_instant_and_joint():
    machine = block()
    feed = np.where(np.arange(100) < 40, 0.0, 1e9)[:, None]
    loop = Loop(machine, ControlLaw.of_joints(Gains(np.zeros(1), np.zeros(1))), STEP)
    still = np.zeros((1, 1))
    with pytest.raises(SolverError, match="diverges") as refused:
        loop.run(loop.start(MotionState(still, still, still)), Inputs(feed, 0.0 * feed, 0.0 * feed))
    assert refused.value.evidence["time"] == 40 * STEP
    assert refused.value.evidence["joint"] == 1
