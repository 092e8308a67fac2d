"""Break the diagnosis on purpose, and see a law fail: a law that cannot fail holds nothing."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pytest
from scipy.sparse import csr_array

from tests.core.diagnosis import test_every_cause, test_held_out
from tests.core.diagnosis.processes import SLOW
from tests.core.diagnosis.regression import gls_world, test_ar_noise, test_gls, test_score_test
from tests.core.diagnosis.regression.gls_world import Equations
from tests.core.diagnosis.scenes import eventful_scene
from tests.core.diagnosis.search import test_stepwise
from veritorque.core.diagnosis.causes import external_contact
from veritorque.core.diagnosis.causes.registry import BY_ID
from veritorque.core.diagnosis.causes.torque_gain import TorqueGain
from veritorque.core.diagnosis.regression.ar_noise import ARNoise
from veritorque.core.diagnosis.regression.gls import refit
from veritorque.core.diagnosis.regression.prewhitening import Prewhitened
from veritorque.core.diagnosis.regression.rows import rows_of_joints
from veritorque.core.diagnosis.search import stepwise as selection
from veritorque.core.dynamics.terms.effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class Measured(OneJointTerm):
    """Give the measured torque for what is predicted."""

    torque: np.ndarray
    symbols = (("G", "1", None),)
    kind = "measured"

    def columns(self, state):
        rows = np.linspace(0.0, len(self.torque) - 1.0, len(state.position))
        return [np.interp(rows, np.arange(len(self.torque)), self.torque[:, self.joint - 1])]


class Endogenous(TorqueGain):
    """Suspect a torque gain as one should not."""

    def term(self, at):
        return Measured(at.joint, at.dataset.torque)


def test_a_column_of_measured_torque_is_seen():
    law = test_every_cause.test_columns_come_from_the_prediction_and_not_from_the_measured_torque
    law(TorqueGain(), eventful_scene())
    with pytest.raises(AssertionError):
        law(Endogenous(), eventful_scene())


@pytest.mark.parametrize(
    "law",
    [
        lambda: test_ar_noise.test_what_was_learned_from_coloured_noise_makes_it_white(SLOW, 0),
        lambda: test_ar_noise.test_the_likelihood_of_gappy_rows_is_that_of_the_dense_normal_distribution(
            SLOW
        ),
        lambda: test_gls.test_a_fit_under_known_noise_is_the_generalised_least_squares_of_dense_matrices(
            Equations()
        ),
        partial(test_gls.test_parameters_scatter_as_their_covariance_says, ordinary=False),
        test_score_test.test_where_nothing_is_hidden_and_the_noise_was_learned_small_chances_stay_rare,
    ],
    ids=["white", "likelihood", "dense", "scatter", "chances"],
)
def test_rows_taken_for_independent_are_seen(law, monkeypatch):
    law()
    monkeypatch.setattr(
        ARNoise,
        "weights",
        property(
            lambda noise: np.repeat(np.eye(1, noise.order + 1), noise.order + 1, axis=0) / noise.deviations[0]
        ),
    )
    with pytest.raises(AssertionError):
        law()


def test_a_row_that_looks_across_a_gap_is_seen(monkeypatch):
    law = test_ar_noise.test_a_row_after_a_gap_knows_nothing_of_the_rows_before_it
    law()
    honest = ARNoise.whitened
    monkeypatch.setattr(
        ARNoise, "whitened", lambda noise, columns, place: honest(noise, columns, np.arange(len(place)))
    )
    with pytest.raises(AssertionError):
        law()


def test_friction_at_rest_that_is_left_in_the_rows_is_seen(monkeypatch):
    law = test_gls.test_what_free_columns_can_stand_for_does_not_reach_the_parameters
    law(Equations())

    def without_standstill(dataset, columns, mask):
        bare = tuple(csr_array((len(dataset.time), 0)) for _ in range(dataset.joints))
        return rows_of_joints(replace(dataset, sticking=bare), columns, mask)

    monkeypatch.setattr(gls_world, "rows_of_joints", without_standstill)
    with pytest.raises(AssertionError):
        law(Equations())


def test_friction_at_rest_that_is_taken_out_row_by_row_is_seen(monkeypatch):
    law = partial(test_gls.test_noise_beside_friction_at_rest_is_learned_as_that_noise_would_have_it, 0)
    law()
    monkeypatch.setattr(Prewhitened, "residual", lambda white, rows, values: rows.residual(values))
    with pytest.raises(AssertionError):
        law()


def test_a_noise_model_that_was_learned_with_the_effect_in_it_is_seen(monkeypatch):
    law = partial(test_gls.test_the_noise_is_learned_anew_where_a_column_takes_an_effect_away, ordinary=False)
    law()
    monkeypatch.setattr(test_gls, "refit", partial(refit, rounds=0))
    with pytest.raises(AssertionError):
        law()


def test_a_fit_that_sees_what_is_held_out_is_seen(monkeypatch):
    law = test_held_out.test_a_fit_does_not_see_what_is_held_out
    law()
    honest = test_held_out.fitter_of

    def all_rows(scene, causes):
        seen = replace(scene.dataset, held_out=np.zeros_like(scene.dataset.held_out))
        return honest(replace(scene, dataset=seen), causes)

    monkeypatch.setattr(test_held_out, "fitter_of", all_rows)
    with pytest.raises(AssertionError):
        law()


def test_a_search_that_looks_at_what_is_held_out_is_seen(monkeypatch):
    law = partial(
        test_held_out.test_a_cause_settles_where_to_look_without_what_is_held_out, BY_ID["external_contact"]
    )
    law()
    monkeypatch.setattr(external_contact, "fitted_rows", lambda dataset: dataset.clear)
    with pytest.raises(AssertionError):
        law()


def test_a_search_that_never_looks_back_is_seen(monkeypatch):
    law = test_stepwise.test_a_false_cause_that_comes_first_is_taken_back_when_the_true_ones_are_found
    law()
    monkeypatch.setattr(test_stepwise, "misled", test_stepwise.misled.__wrapped__)
    monkeypatch.setattr(selection, "_exits_and_swaps", lambda state: [state])
    with pytest.raises(AssertionError):
        law()
