"""Hold weights, robust weights and smoothing widths to what they are for."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters, world_of
from tests.tools import random_robot
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.terms.coulomb import Coulomb
from veritorque.core.errors import ExcitationError
from veritorque.core.estimate.smoothing import SHARES
from veritorque.core.estimate.system import joint_noise, ordinary, stacked, weighted
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.regressor.factor import Factor
from veritorque.core.study import IdentifyRequest, identify_in_full


def test_weighing_joints_by_their_noise_beats_not_weighing_them_when_they_differ():
    robot = random_robot(np.random.default_rng(4), 3, prismatic=0.0)
    errors = {"weighted": 0.0, "ordinary": 0.0}
    for seed in range(25):
        world = world_of(robot, seed=seed, samples=80, noise=(5.0, 0.05, 0.05))
        for name, fit in (("weighted", weighted), ("ordinary", ordinary)):
            found = fit(world.factors, world.columns_of, len(world.true_base)).solved()
            quiet = [row for row in range(len(found)) if world.base.parameter(row).joint > 1]
            errors[name] += float(np.sum((found - world.true_base)[quiet] ** 2))
    assert errors["weighted"] < 0.1 * errors["ordinary"]


def test_the_noise_of_every_joint_is_found():
    world = world_of(planar_robot(), samples=4000, noise=(0.5, 0.02))
    # 4000 samples tell a deviation to about 1 / sqrt(8000) = 1.1 %; four of those.
    np.testing.assert_allclose(world.system.noise, (0.5, 0.02), rtol=0.045)
    noise = joint_noise(world.factors, world.columns_of, world.true_base)
    np.testing.assert_allclose(noise, world.system.noise, rtol=0.01)


def test_fewer_equations_than_parameters_are_refused_with_both_numbers():
    with pytest.raises(ExcitationError) as refusal:
        world_of(planar_robot(), samples=6)
    assert refusal.value.evidence == {"equations": 12, "parameters": 13}


def test_a_joint_without_any_torque_does_not_outweigh_the_others_to_infinity():
    world = world_of(planar_robot(), noise=0.0, samples=100)
    assert np.all(np.isfinite(world.system.triangle))
    np.testing.assert_allclose(world.system.solved(), world.true_base, atol=1e-6)


@pytest.mark.parametrize("rows", [3, 13, 14, 15])
def test_the_cost_is_that_of_the_rows_however_few_they_are(rows):
    rng = np.random.default_rng(rows)
    equations = rng.normal(size=(rows, 14))
    system = stacked((Factor.of(equations),), (np.arange(13),), 13, np.ones(1))
    values = rng.normal(size=13)
    assert system.triangle.shape == (13, 13)
    miss = equations[:, -1] - equations[:, :-1] @ values
    assert system.cost(values) == pytest.approx(float(miss @ miss), rel=1e-12)


def _spiked() -> tuple[object, object, np.ndarray]:
    model = standard_model(planar_robot())
    truth = true_parameters(model)
    rng = np.random.default_rng(5)
    state = swing(2)
    noise = 0.05 * rng.normal(size=state.position.shape)
    bursts = rng.random(noise.shape) < 0.0015  # of seven samples each: a median of five passes them on
    hits = np.logical_or.reduce([np.roll(bursts, shift, axis=0) for shift in range(7)])
    return model, log_of(model, truth, state, noise + 40.0 * hits), truth


def test_robust_weights_shrug_off_spikes_that_pull_the_plain_fit_away():
    model, log, truth = _spiked()
    errors = {}
    for estimator in ("wls", "irls"):
        options = {
            "estimator": estimator,
            "bootstrap": {"draws": 0},
            "filter": {"cutoff_hz": 20, "decimation": 1},
        }
        found = identify_in_full(IdentifyRequest(model.robot, (log,), options))
        errors[estimator] = np.linalg.norm(found.estimate.base - found.base.base_of(truth))
    assert errors["irls"] < 0.6 * errors["wls"]


@pytest.mark.parametrize("share", [share for share in SHARES if share >= 0.1])
def test_a_smoothing_width_of_a_tenth_of_the_speed_or_more_is_found_where_it_was_planted(share):
    plain = standard_model(planar_robot())
    state = swing(2)
    speed = np.sqrt(np.mean(state.velocity**2, axis=0))
    smooth = plain.with_term(Coulomb(tuple(float(one) for one in share * speed)))
    truth = true_parameters(smooth)
    log = log_of(smooth, truth, state, 1e-3 * np.random.default_rng(1).normal(size=state.position.shape))
    options = {"smooth_coulomb": True, "bootstrap": {"draws": 0}, "filter": {"cutoff_hz": 15}}
    found = identify_in_full(IdentifyRequest(plain.robot, (log,), options))
    np.testing.assert_allclose(found.widths, share * speed, rtol=0.1)


def test_a_plain_sign_is_kept_where_friction_is_plain():
    model = standard_model(planar_robot())
    state = swing(2)
    log = log_of(model, true_parameters(model), state)
    rows = whole_rows(log)
    exact = replace(log, source=log_from_arrays("again", rows.time, rows.position, rows.torque).source)
    options = {"smooth_coulomb": True, "bootstrap": {"draws": 0}, "filter": {"cutoff_hz": 15}}
    found = identify_in_full(IdentifyRequest(model.robot, (exact,), options))
    # The measured velocity changes sign up to half a sample late, which a width of a hundredth may imitate.
    speed = np.sqrt(np.mean(state.velocity**2, axis=0))
    assert np.all(np.array(found.widths) <= 0.011 * speed)
