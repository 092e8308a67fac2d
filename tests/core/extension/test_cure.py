"""Extending a model leaves what it was, adds what was found, and gains where the effect is."""

from dataclasses import dataclass

import numpy as np
import pytest

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.dynamics.term import Term
from veritorque.core.dynamics.terms.friction_stribeck import Stribeck
from veritorque.core.dynamics.terms.time_delay import Delay
from veritorque.core.dynamics.terms.torque_gain import TorqueGain
from veritorque.core.extension.cure import extended_base
from veritorque.core.extension.gain import JointGain, gains
from veritorque.core.log.model import JointLog
from veritorque.core.reduction.base import BaseModel, base_model
from veritorque.core.regressor.columns import ColumnPlan
from veritorque.core.regressor.observe import Observation, observe
from veritorque.core.signals.condition import condition
from veritorque.core.signals.recipe import FilterOptions

BLOCKS, HELD = 10, (6, 7, 8, 9)
SIZE, VELOCITY, NOISE = 1.5, 0.4, 0.05


@dataclass(frozen=True, eq=False)
class World:
    """Hold a log with Stribeck friction on joint 2, and the standard model's base and true parameters."""

    base: BaseModel
    truth: np.ndarray
    log: JointLog
    effect: Term

    def observed(self, base: BaseModel) -> Observation:
        motion = condition(self.log, base.model.robot, FilterOptions(), blocks=BLOCKS)
        held_out = frozenset((0, block) for block in HELD)
        return observe(ColumnPlan(base.model, base.kept), (motion,), held_out=held_out)

    def gained(self, value: float, held: tuple[int, ...] = HELD) -> tuple[JointGain, ...]:
        """Judge the model with the effect of a given size against the one without."""
        whole, old = extended_base(self.base, (self.effect,)), self.base.base_of(self.truth)
        before, after = (self.observed(base) for base in (self.base, whole))
        return gains((before, old), (after, np.append(old, value)), held)


@pytest.fixture(scope="module")
def world() -> World:
    model = standard_model(planar_robot())
    truth, state, rng = true_parameters(model), swing(2, seconds=30.0), np.random.default_rng(0)
    speed = state.velocity[:, 1]
    noise = NOISE * rng.normal(size=state.position.shape)
    noise[:, 1] += SIZE * np.sign(speed) * np.exp(-((speed / VELOCITY) ** 2))
    return World(base_model(model), truth, log_of(model, truth, state, noise), Stribeck(2, VELOCITY))


def test_a_trials_equations_are_the_same_out_of_all_findings_as_observed_by_themselves(world):
    """Terms on one joint and on all, before and behind the one that is left out."""
    believed = Prediction(world.base.model, world.truth)
    terms = (TorqueGain(1, believed), world.effect, Delay(0, believed, 0.01))
    all_of_them, trial = (extended_base(world.base, some) for some in (terms, (terms[0], terms[2])))
    old = len(world.base.kept)
    places = np.array([*range(old), old, old + 2])
    one, other = world.observed(trial), world.observed(all_of_them)
    assert len(other.plan.columns) == len(places) + 1
    taken = other.over(one.plan, places)
    assert taken.kept == one.kept
    for alone, out in zip(one.blocks, taken.blocks, strict=True):
        for first, second in zip(alone.factors, out.factors, strict=True):
            assert first.rows == second.rows
            grams = [part.triangle.T @ part.triangle for part in (first, second)]
            np.testing.assert_allclose(*grams, rtol=1e-9, atol=1e-9 * np.abs(grams[0]).max())
    for first, second in zip(one.memory, taken.memory, strict=True):
        np.testing.assert_allclose(second.products, first.products, rtol=1e-9, atol=1e-9)


def test_the_standard_parameters_keep_their_names_and_groupings(world):
    believed = Prediction(world.base.model, world.truth)
    whole = extended_base(world.base, (world.effect, TorqueGain(1, believed)))
    old = range(len(world.base.kept))
    assert whole.names[: len(old)] == world.base.names
    assert [whole.relation(row) for row in old] == [world.base.relation(row) for row in old]
    assert whole.model.parameters[: len(world.truth)] == world.base.model.parameters


def test_every_parameter_of_a_finding_stands_for_itself(world):
    whole = extended_base(world.base, (world.effect,))
    values = np.append(world.truth, SIZE)
    np.testing.assert_array_equal(whole.base_of(values), np.append(world.base.base_of(world.truth), SIZE))


def test_an_extension_of_size_zero_is_the_old_model(world):
    whole, state = extended_base(world.base, (world.effect,)), swing(2, seconds=2.0)
    np.testing.assert_array_equal(
        whole.model.torque(np.append(world.truth, 0.0), state), world.base.model.torque(world.truth, state)
    )
    for one in world.gained(0.0):
        assert one.improvement_percent == pytest.approx(0.0, abs=1e-6)
        assert one.interval_95 == pytest.approx((0.0, 0.0), abs=1e-6)


def test_the_true_size_makes_the_residual_on_held_out_blocks_smaller_only_where_the_effect_is(world):
    other, own = world.gained(SIZE)
    assert own.rms_after < 0.5 * own.rms_before
    assert 50.0 < own.interval_95[0] < own.improvement_percent < own.interval_95[1]
    assert other.rms_after == pytest.approx(other.rms_before, rel=1e-9)


def test_a_wrong_sign_makes_it_worse_beyond_doubt(world):
    own = world.gained(-SIZE)[1]
    assert own.improvement_percent < own.interval_95[1] < 0.0


def test_fewer_than_four_blocks_give_a_gain_without_an_interval(world):
    own = world.gained(SIZE, HELD[:3])[1]
    assert own.improvement_percent > 50.0
    assert own.interval_95 is None
