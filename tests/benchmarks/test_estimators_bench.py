"""The bench of the estimators: its engine is true, and its table drops no run and no estimator.

A short log of a planar arm and few estimators show all columns; accuracy is not judged here.
"""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from benchmarks.estimators.arms import driven
from benchmarks.estimators.bench import usual_names
from benchmarks.estimators.bounds import Information
from benchmarks.estimators.cells import ORACLE, WITH_CONTROLLER, Cell, Ledger, Result, measure
from benchmarks.estimators.loops import LOOPS, loop_of
from benchmarks.estimators.plant import STEP, Plant
from benchmarks.estimators.summary import COLUMNS, figures, markdown, summarised
from benchmarks.estimators.worlds import NOISES, world
from tests.tools import pinocchio_model
from veritorque.core.estimate.methods.registry import ESTIMATORS
from veritorque.core.log.model import whole_rows
from veritorque.core.regressor.columns import dense
from veritorque.core.robot.inertia import pseudo_inertia
from veritorque.core.signals.condition import condition
from veritorque.core.simulation.closed_loop.controlled import Controlled
from veritorque.core.simulation.closed_loop.simulated import SimulatedMotion
from veritorque.core.simulation.control.own_controller import controller_of
from veritorque.core.simulation.mechanism import mechanism_of

SECONDS = 1.5
SOFT, STIFF = "planar-L1-coulomb-fast", "planar-L2-coulomb-fast"
NOISE, HIDDEN = "1e-3/.05", "didim (controller)"


@pytest.fixture(scope="module")
def ledger(tmp_path_factory) -> Ledger:
    """Run few estimators twice; L2's logs do not show their controller, so that one of them fails."""
    names = {
        place: dict.fromkeys((ORACLE, "sdp", one), 2) for place, one in ((SOFT, "didim"), (STIFF, HIDDEN))
    }
    cells = [Cell(place, NOISE, runs, SECONDS) for place, runs in names.items()]
    kept = Ledger(tmp_path_factory.mktemp("bench") / "results.jsonl")
    measure(cells, kept)
    return kept


def row(ledger, place, name):
    return next(one for one in summarised(ledger) if (one.world, one.estimator) == (place, name))


def test_every_estimator_is_run_where_the_logs_allow_it():
    assert set(ESTIMATORS) < set(usual_names(SOFT))
    assert {f"{name} (controller)" for name in WITH_CONTROLLER} < set(usual_names(SOFT))
    assert set(usual_names(STIFF)) == {ORACLE, *ESTIMATORS}


def test_the_table_has_all_columns_and_a_row_per_cell_and_estimator(ledger):
    rows = summarised(ledger)
    assert len({figure.name for figure in figures(rows)}) == len(rows) == 6
    lines = [line for line in markdown(rows).splitlines() if line.startswith("|")]
    assert {line.count("|") for line in lines} == {len(COLUMNS) + 1}
    own = row(ledger, SOFT, "sdp")
    assert own.runs == 2
    assert 0.0 < own.bias <= own.error < 10.0
    assert own.error**2 <= (own.friction + own.inertia) ** 2 * 1.001
    assert min(own.of_oracle, own.of_bound, own.coverage, own.feasible, own.cpu, own.steps) > 0.0
    assert row(ledger, SOFT, ORACLE).of_oracle == 1.0
    assert row(ledger, STIFF, "sdp").of_bound is None


def test_a_run_that_fails_is_counted_and_errs_as_much_as_its_start(ledger):
    failed = row(ledger, STIFF, HIDDEN)
    assert (failed.runs, failed.failed, failed.feasible, failed.coverage) == (2, 2, 0.0, None)
    assert 1.0 < failed.error < 15.0
    assert row(ledger, SOFT, "didim").failed == 0
    causes = {one.failure for one in ledger.results() if one.base is None}
    assert causes == {"the log does not show its controller, which was to be simulated"}


def test_what_a_file_holds_is_not_run_again(ledger):
    again = Ledger(ledger.path)
    before = list(again.rows)
    measure([Cell(SOFT, NOISE, {ORACLE: 2, "sdp": 2}, SECONDS)], again)
    assert again.rows == before == ledger.rows


def test_scatter_counts_in_the_error_and_not_in_the_bias():
    kept, size = Ledger(None), 3
    scene = {"names": ["a"] * size, "truth": [1.0] * size, "friction": [True, False, False]}
    kept.add({"kind": "scene", "world": "w", "triangle": np.eye(size).tolist(), **scene})
    for run, sign in enumerate((1.0, -1.0)):
        base = [1.0 + 0.01 * sign, 1.02, 1.0]
        one = Result("w", NOISE, "sdp", run, base, [0.01, 0.01, 0.01])
        kept.add({"kind": "run", **vars(one)})
    (own,) = summarised(kept)
    assert own.error == pytest.approx(100.0 * np.sqrt((0.01**2 + 0.02**2) / size))
    assert own.bias == pytest.approx(100.0 * 0.02 / np.sqrt(size))
    assert own.friction == pytest.approx(100.0 * 0.01 / np.sqrt(size))
    assert own.coverage == pytest.approx(100.0 * 2.0 / 3.0)


def test_the_bound_adds_the_information_of_positions_and_torques():
    own = Information(np.array([[2.0, 0.0], [0.0, 1e-3]]), np.array([[0.0, 0.0], [0.0, 4.0]]))
    noise = np.rad2deg(0.1), 0.5
    np.testing.assert_allclose(own.deviations(noise), [0.1 / 2.0, 0.5 / 4.0], rtol=1e-4)


@pytest.mark.parametrize("loop", LOOPS)
@pytest.mark.parametrize("friction", ["coulomb", "presliding"])
def test_the_logged_torque_is_that_of_the_true_columns(loop, friction):
    own = world(f"planar-{loop}-{friction}-fast", 0.4)
    run = own.drawn((0.0, 0.0), 0)
    missed = dense(own.plan, run.state) @ own.truth - run.torque.ravel()
    assert np.linalg.norm(missed) < 1e-5 * np.linalg.norm(run.torque)


def test_without_friction_the_arm_accelerates_as_the_algorithm_of_articulated_bodies_says():
    own = driven("tx40")
    none = np.zeros(6)
    arm = replace(own.arm, coulomb=none + 1e-12, viscous=none)
    plant = Plant(arm, loop_of("L1", replace(own, arm=arm)))
    run = plant.run(world("tx40-L1-coulomb-slow", 0.1).motion, 0.1)
    model = pinocchio_model(arm.robot, arm.bodies)
    model.armature = arm.rotor_inertia
    state, data = run.state, model.createData()
    parts = zip(state.position, state.velocity, run.torque, strict=True)
    wanted = np.array([pin.aba(model, data, *part) for part in parts])
    assert np.abs(wanted - state.acceleration).max() < 50.0 * STEP * np.abs(wanted).max()


def test_birdys_bodies_can_exist():
    assert min(np.linalg.eigvalsh(pseudo_inertia(body))[0] for body in driven("tx40").arm.bodies) > 0.0


def test_noise_goes_round_the_loop_and_the_command_is_made_of_what_the_encoders_show():
    own = world(SOFT, 1.2)
    still, noisy = (own.drawn((size, 0.0), 0) for size in (0.0, 1e-2))
    assert np.std(noisy.seen - noisy.state.position) == pytest.approx(np.deg2rad(1e-2), rel=0.1)
    assert np.abs(noisy.torque - still.torque).max() > 0.1
    found = controller_of(own.log(noisy, NOISES[NOISE], 0))
    np.testing.assert_allclose(found.model.kp, 0.1 * own.plant.loop.driven.kp, rtol=1e-6)
    assert found.model.velocity == "backward"


@pytest.mark.parametrize("loop", ["L1", "L3"])
def test_the_product_simulates_the_arm_as_this_engine_does(loop):
    own = world(f"planar-{loop}-coulomb-fast", 1.5)
    run = own.drawn((0.0, 0.0), 0)
    log = own.log(run, (0.0, 0.0), 0)
    motion, machine = condition(log, own.plant.arm.robot), mechanism_of(own.model, own.standard)
    moved = SimulatedMotion(motion, machine, Controlled(controller_of(log).model), round(1e-3 / STEP))
    tile = next(iter(moved.tiles()))
    rows = np.rint(tile.state.time * 1000.0).astype(int)
    settled = rows > 700
    apart = (tile.state.position - whole_rows(log).position[rows])[settled]
    assert np.sqrt(np.mean(apart**2)) < 5e-6
