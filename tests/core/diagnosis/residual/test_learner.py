"""Hold the generic learner to silence on noise, and to finding what no listed cause describes."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from tests.core.diagnosis.residual.worlds import NOISES, on_joint, world
from veritorque.core.diagnosis.residual import blocks, learner
from veritorque.core.diagnosis.residual.learner import predictable_share
from veritorque.core.diagnosis.thresholds.residual import PREDICTION


@pytest.mark.parametrize("kind", NOISES)
def test_nothing_is_predictable_of_noise_whatever_its_colour(kind):
    # Seven joints per colour; of 700 joints over 100 such logs none was alarmed.
    here = world()
    residual, noise = here.left(here.noise(kind, seed=11))
    found = predictable_share(here.dataset, residual, here.operating_point, noise)
    assert [one.joint for one in found if one.interval[0] > 0.0] == []
    assert max(one.share for one in found) < 0.05
    assert all(one.places == () for one in found)


def test_a_product_of_two_joints_speeds_is_found_although_no_cause_describes_it():
    here = world()
    velocity = here.dataset.state.velocity
    effect = on_joint(here, 2, velocity[:, 0] * velocity[:, 1])
    alone, _ = here.left(effect + 1e-3 * here.noise("white", seed=1))
    residual, noise = here.left(effect + 0.5 * here.noise("white", seed=1))
    found = predictable_share(here.dataset, residual, here.operating_point, noise)
    clear = here.dataset.clear[:, 1]
    truth = np.var(alone[clear, 1]) / (np.var(alone[clear, 1]) + 0.25)
    assert found[1].interval[0] > 0.3
    assert found[1].share == pytest.approx(truth, abs=0.15)
    assert found[1].interval[0] <= truth
    assert [one.joint for one in found if one.interval[0] > 0.0] == [2]


def test_the_places_are_where_the_effect_was_put():
    here = world()
    position = here.dataset.state.position[:, 3]
    middle, width = np.median(position), 0.15 * np.std(position)
    bump = np.exp(-(((position - middle) / width) ** 2))
    residual, noise = here.left(on_joint(here, 4, bump) + 0.5 * here.noise("white", seed=2))
    found = predictable_share(here.dataset, residual, here.operating_point, noise)[3]
    assert found.interval[0] > 0.0
    place = next(one for one in found.places if one.coordinate == "position")
    assert place.low - width < middle < place.high + width
    assert place.unit == "rad"
    assert found.places[0].rms == max(one.rms for one in found.places)


def test_noise_passes_for_structure_where_blocks_are_shorter_than_its_memory(monkeypatch):
    here = world()
    residual, noise = here.left(here.noise("ar_0.98", seed=3))
    finer = replace(PREDICTION, blocks=400, longest_gap=0.0)
    for module in (blocks, learner):
        monkeypatch.setattr(module, "PREDICTION", finer)
    found = predictable_share(here.dataset, residual, here.operating_point, noise)
    assert sum(one.interval[0] > 0.0 for one in found) >= 2


def test_the_same_residual_gives_the_same_share():
    here = world()
    residual, noise = here.left(on_joint(here, 1, np.sin(3.0 * here.dataset.state.position[:, 0])))
    one, other = (predictable_share(here.dataset, residual, here.operating_point, noise)[0] for _ in range(2))
    assert (one.share, one.interval, one.places) == (other.share, other.interval, other.places)


def test_nothing_is_said_of_a_log_too_short_to_hold_anything_out():
    here = world()
    short = replace(here.dataset, clear=here.dataset.clear & (here.dataset.time < 2.0)[:, None])
    residual, noise = here.left(here.noise("white", seed=4))
    found = predictable_share(short, residual, here.operating_point, noise)
    assert all(np.isnan([one.share, *one.interval, one.rms]).all() for one in found)


def test_a_joint_that_hardly_moves_is_not_judged_while_the_others_are():
    here = world()
    joints = np.arange(here.dataset.joints) > 0
    parked = replace(here.dataset, clear=here.dataset.clear & joints)
    residual, noise = here.left(here.noise("white", seed=4))
    first, *others = predictable_share(parked, residual, here.operating_point, noise)
    assert np.isnan([first.share, *first.interval, first.rms, *first.prediction]).all()
    assert all(np.isfinite([one.share, *one.interval, one.rms]).all() for one in others)


def test_a_coordinate_that_is_not_known_at_every_row_is_left_out():
    here = world()
    residual, noise = here.left(on_joint(here, 1, np.sin(3.0 * here.dataset.state.position[:, 0])))
    temperature = np.full_like(here.dataset.torque, np.nan)
    warm = replace(here.dataset, state=replace(here.dataset.state, temperature=temperature))
    one, other = (
        predictable_share(dataset, residual, here.operating_point, noise)[0]
        for dataset in (here.dataset, warm)
    )
    assert (one.share, one.interval) == (other.share, other.interval)


def test_the_trees_are_loaded_only_where_they_are_grown():
    trees = "veritorque.core.numerics.boosted_trees"
    code = f"import sys, veritorque.core.diagnosis.residual.learner; sys.exit('{trees}' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
