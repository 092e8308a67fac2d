"""Replay of a log: the true robot does what was measured, and every part begins as it was measured."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.simulation.worlds import block, mechanism
from veritorque.core.dynamics.terms.friction_presliding import Presliding
from veritorque.core.errors import OptionError
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.signals.condition import condition
from veritorque.core.signals.recipe import FilterOptions
from veritorque.core.simulation.closed_loop.replay import Replay, default_gains
from veritorque.core.simulation.closed_loop.simulated import SimulatedMotion
from veritorque.core.simulation.mechanism import mechanism_of


def played_again(mechanism, motion, bandwidth_hz=5.0):
    """Replay a motion with gains for the inertia along it."""
    positions = np.vstack([tile.state.position[::50] for tile in motion.tiles()])
    gains = default_gains(mechanism, positions, bandwidth_hz)
    return SimulatedMotion(motion, mechanism, Replay(gains, mechanism))


def deviations(mechanism, motion, bandwidth_hz=5.0):
    """Give the RMS of simulated less measured positions, joint by joint, where samples are usable."""
    played = played_again(mechanism, motion, bandwidth_hz)
    apart = [
        (other.state.position - tile.state.position)[tile.first : -tile.parallel.reach]
        for other, tile in zip(played.tiles(), motion.tiles(), strict=True)
    ]
    return np.sqrt(np.mean(np.vstack(apart) ** 2, axis=0))


def test_the_true_robot_does_what_was_measured_and_a_wrong_one_does_not(arm, motion):
    true, wrong = (deviations(mechanism(*arm, FC=1.0, OFF=offset), motion) for offset in (0.0, 2.0))
    assert np.all(true < 5e-4)
    assert np.all(wrong > 5.0 * true)


def test_a_firmer_controller_keeps_a_wrong_robot_nearer(arm, motion):
    soft, firm = (deviations(mechanism(*arm, FC=1.0, OFF=2.0), motion, band) for band in (2.0, 10.0))
    assert np.all(firm < 0.5 * soft)


def test_tiles_continue_each_other_and_hold_what_is_not_simulated(arm, motion):
    played = played_again(mechanism(*arm, FC=1.0), motion)
    assert played.kept == motion.kept
    before = None
    for other, tile in zip(played.tiles(), motion.tiles(), strict=True):
        np.testing.assert_allclose(other.state.time, tile.state.time, atol=1e-9)
        np.testing.assert_array_equal(other.torque, tile.torque)
        np.testing.assert_array_equal(other.usable, tile.usable)
        if before is not None and tile.follows:
            shared = np.count_nonzero(before.state.time > tile.state.time[0] - 1e-9)
            assert shared > 0
            np.testing.assert_array_equal(other.state.position[:shared], before.state.position[-shared:])
        before = other
    assert before is not None
    assert np.all(np.abs(before.state.friction_share) <= 1.0)


def test_a_joint_whose_torque_was_not_measured_is_driven_by_the_model(arm, motion):
    true, rows = mechanism(*arm, FC=1.0), whole_rows(motion.log)
    torque = rows.torque.copy()
    torque[:, 1] = 0.0
    log = log_from_arrays("silent", rows.time, rows.position, torque)
    assert "missing_torque" in {defect.kind for defect in log.defects}
    assert np.all(deviations(true, condition(log, true.robot)) < 1e-3)


def test_a_part_behind_a_gap_begins_as_it_was_measured(arm, motion):
    rows = whole_rows(motion.log)
    kept = np.r_[0 : len(rows.time) // 2, len(rows.time) // 2 + 300 : len(rows.time)]
    log = log_from_arrays("gap", rows.time[kept], rows.position[kept], rows.torque[kept])
    parted = condition(log, motion_robot(arm), FilterOptions())
    played = played_again(mechanism(*arm, FC=1.0), parted)
    pairs = zip(played.tiles(), parted.tiles(), strict=True)
    begun = [(other, tile) for other, tile in pairs if not tile.follows]
    assert len(begun) == 2
    for other, tile in begun:
        np.testing.assert_array_equal(other.state.position[0], tile.state.position[0])


def motion_robot(arm):
    """Give the robot that a mechanism is of."""
    return mechanism(*arm, FC=1.0).robot


def test_a_model_with_a_term_that_is_not_simulated_is_refused(arm, motion):
    plain = mechanism(*arm, FC=1.0)
    model = replace(plain.model, terms=(*plain.model.terms, Presliding(1, 0.01)))
    longer = np.append(plain.parameters, np.zeros(len(model.parameters) - len(plain.parameters)))
    played = played_again(mechanism_of(model, longer), motion)
    with pytest.raises(OptionError, match="terms"):
        next(played.tiles())


def test_default_gains_damp_a_joint_critically_at_the_bandwidth():
    gains = default_gains(block(), np.zeros((3, 1)), 5.0)
    rate = np.sqrt(gains.stiffness / 2.0)
    np.testing.assert_allclose(rate, 2.0 * np.pi * 5.0)
    np.testing.assert_allclose(gains.damping / (2.0 * 2.0 * rate), 1.0)
