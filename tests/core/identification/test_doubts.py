"""Hold the doubts: a sound study raises none, and nonsense that still has an optimum is named."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.estimate.constraints import link_columns
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.study import IdentifyRequest, identify


@pytest.fixture(scope="module")
def world():
    model = standard_model(planar_robot())
    state = swing(2)
    rows = whole_rows(
        log_of(
            model,
            true_parameters(model),
            state,
            0.02 * np.random.default_rng(4).normal(size=state.position.shape),
        )
    )
    return model.robot, rows


def _doubts(robot, rows, position=None, torque=None, **options):
    log = log_from_arrays(
        "log",
        rows.time,
        rows.position if position is None else position,
        rows.torque if torque is None else torque,
    )
    return identify(IdentifyRequest(robot, (log,), {"bootstrap": {"draws": 0}} | options))["doubts"]


def test_a_sound_study_raises_no_doubt(world):
    assert _doubts(*world) == []


def test_torque_of_the_opposite_sign_is_doubted_where_it_is_not_corrected(world):
    robot, rows = world
    found = _doubts(robot, rows, torque=-rows.torque, conflicts="report")
    assert found[0].startswith("Robot and log disagree: all torques have the opposite sign")
    assert any("consistency constraint raises the squared error" in one and "sign" in one for one in found)
    assert any("opposite sign" in one and "joint 1" in one for one in found)


def test_torque_of_the_opposite_sign_leaves_no_doubt_but_itself_once_it_is_corrected(world):
    robot, rows = world
    found = _doubts(robot, rows, torque=-rows.torque)
    assert len(found) == 1
    assert found[0].startswith("Robot and log disagree: all torques have the opposite sign")


def test_a_spike_in_motion_that_is_held_out_is_no_worse_prediction(world):
    robot, rows = world
    for place in np.linspace(0.05, 0.95, 6):  # some part of the log is held out, the rest is fitted
        torque = rows.torque.copy()
        torque[int(place * len(torque)), 1] += 50.0 * np.abs(torque[:, 1]).max()
        assert not [one for one in _doubts(robot, rows, torque=torque) if "held-out" in one]


def test_a_joint_that_stands_is_named_as_not_excited(world):
    robot, rows = world
    still = rows.position.copy()
    still[:, 1] = 0.3
    (doubt,) = [one for one in _doubts(robot, rows, position=still) if "does not excite" in one]
    assert "FC2" in doubt
    assert "FC1" not in doubt


def test_a_model_that_explains_little_is_doubted(world):
    assert any("unexplained" in one for one in _doubts(*world, terms=["viscous"]))


def test_torques_of_another_run_are_said_to_be_none_of_these_positions_and_not_to_be_computed(world):
    robot, rows = world
    model = standard_model(robot)
    found = _doubts(robot, rows, torque=model.torque(true_parameters(model), swing(2, seed=7)))
    (doubt,) = [one for one in found if "unexplained" in one]
    assert "of every joint's RMS torque" in doubt
    assert "different runs" in doubt
    assert not [one for one in found if "no friction" in one]


@pytest.mark.parametrize(
    ("factor", "said"), [(1e5, "in whole numbers"), (1e3, "read as mN m it would be")], ids=["counts", "mN m"]
)
def test_what_a_log_shows_against_itself_is_doubted_whatever_the_fit(world, factor, said):
    robot, rows = world
    torque = rows.torque * factor * 3000.0 / np.abs(rows.torque).max() / 500.0
    found = _doubts(robot, rows, torque=np.round(torque) if said == "in whole numbers" else torque)
    (doubt,) = [one for one in found if one.startswith("Log log:")]
    assert said in doubt


@pytest.mark.parametrize("factor", [1.0, 0.3, 0.02, 1e-3, 40.0])
def test_torques_of_a_size_far_from_the_described_bodies_are_doubted_and_no_single_one_is(world, factor):
    """All fit as well: only the description tells a unit, a gear or a percentage of all torques."""
    robot, rows = world
    model = standard_model(robot)
    true = true_parameters(model)
    bodies = true[np.array(link_columns(model))]
    found = _doubts(replace(robot, prior=bodies), rows, torque=factor * rows.torque)
    assert [one for one in found if "Robot and log disagree" in one] == []
    doubted = [one for one in found if "the torque of the described ones" in one]
    assert len(doubted) == (factor in (0.02, 1e-3, 40.0))


def test_a_simulation_that_does_not_follow_the_log_is_doubted(world):
    robot, rows = world
    found = _doubts(robot, rows, estimator="oe", simulation={"window_seconds": 10.0}, iteration={"most": 2})
    assert any("its simulation may not follow the log" in one for one in found)


@pytest.mark.parametrize("estimator", ["iv", "didim", "cloe", "oe"])
def test_a_simulation_that_follows_the_log_is_not_doubted(world, estimator):
    assert _doubts(*world, estimator=estimator) == []
