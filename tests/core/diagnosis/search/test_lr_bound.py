"""Hold what is foreseen of candidates to what fitting them brings, where a scan says next to nothing."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.diagnosis.made_up import nothing_found
from tests.core.diagnosis.scenes import Effect, fitter_of, linearised, measured_arm
from tests.core.diagnosis.waves import wave_cause, wave_effect
from veritorque.core.diagnosis.causes.registry import AGAINST_REFERENCE, BY_ID, CAUSES
from veritorque.core.diagnosis.search.entry_test import with_candidate
from veritorque.core.diagnosis.search.fitter import HypothesisFitter
from veritorque.core.diagnosis.search.likelihood_ratio import likelihood_ratio
from veritorque.core.diagnosis.search.lr_bound import predicted_likelihood_ratios
from veritorque.core.diagnosis.thresholds.search import ENTRY
from veritorque.core.estimate.gaussian_prior import GaussianPrior
from veritorque.core.reduction.base import base_model

RATE = 7.0


def drift(state):
    return 5.0 * np.exp(-state.time / 8.0)[:, None] * [1.0, 0.0, 0.0]


def sprung(state):
    return 3.0 * state.position * [1.0, 0.0, 0.0]


def stiff(state):
    return np.sign(state.velocity) * [1.0, 0.0, 0.0]


def free_fitter(effect: Effect) -> HypothesisFitter:
    """Suspect every cause where the rows alone tell the parameters."""
    return fitter_of(measured_arm(effect), CAUSES)


def bench_with_prior(effect: Effect) -> HypothesisFitter:
    """Suspect what may have changed since a reference whose parameters are known within a twentieth."""
    scene = measured_arm(effect)
    values = base_model(scene.operating_point.model).base_of(scene.operating_point.standard)
    rows = np.diag(20.0 / np.maximum(np.abs(values), 1e-3))
    return fitter_of(scene, AGAINST_REFERENCE, GaussianPrior(rows, rows @ values))


BENCHES = {
    "rows alone": free_fitter,
    "ordinary noise": lambda effect: linearised(free_fitter(effect).with_ordinary_noise()),
    "a prior": bench_with_prior,
}


@pytest.mark.parametrize(
    ("effect", "cause"),
    [
        (wave_effect({RATE: 0.3}), wave_cause("wave", {RATE: 1.0})),
        (wave_effect({RATE: 3.0}), wave_cause("wave", {RATE: 1.0})),
        (drift, BY_ID["torque_offset_drift"]),
    ],
    ids=["wave", "large_wave", "drift"],
)
def test_an_effect_that_the_noise_model_has_absorbed_is_predicted_nearly_as_large_as_fitted(effect, cause):
    fitter = fitter_of(measured_arm(effect), (cause,))
    none = nothing_found(fitter)
    hidden = fitter.scan(none)[0]
    brings = likelihood_ratio(none, with_candidate(fitter, none, hidden))
    assert hidden.statistic < 0.2 * brings
    assert predicted_likelihood_ratios(fitter, none, [hidden])[0] == pytest.approx(brings, rel=0.15)


def test_nothing_brings_more_than_so_many_times_what_is_predicted_of_it():
    fitter = fitter_of(measured_arm(sprung), CAUSES)
    none = nothing_found(fitter)
    scans = fitter.scan(none)[:16]
    brings = np.array([likelihood_ratio(none, with_candidate(fitter, none, one)) for one in scans])
    assert brings.max() > 100.0
    assert np.all(
        brings < ENTRY.bound_factor * np.maximum(predicted_likelihood_ratios(fitter, none, scans), 5.0)
    )


def test_beside_what_is_found_already_only_the_rest_is_predicted():
    fitter = fitter_of(measured_arm(sprung), (BY_ID["spring_compensator"], BY_ID["torque_ripple"]))
    none = nothing_found(fitter)
    spring, ripple = fitter.scan(none)[:2]
    assert (spring.candidate.cause.id, ripple.candidate.cause.id) == ("spring_compensator", "torque_ripple")
    beside = with_candidate(fitter, none, spring)
    again = next(one for one in fitter.scan(beside) if one.candidate.key == ripple.candidate.key)
    assert predicted_likelihood_ratios(fitter, none, [ripple])[0] > 100.0
    assert predicted_likelihood_ratios(fitter, beside, [again])[0] < 20.0


@pytest.mark.parametrize("make", BENCHES.values(), ids=BENCHES)
@pytest.mark.parametrize("effect", [drift, sprung], ids=["drift", "sprung"])
def test_of_no_effect_nothing_is_predicted(make, effect):
    fitter = make(effect)
    none = nothing_found(fitter)
    nothing = [replace(one, values=0.0 * one.values) for one in fitter.scan(none)[:8]]
    np.testing.assert_allclose(predicted_likelihood_ratios(fitter, none, nothing), 0.0, atol=5.0)


@pytest.mark.parametrize(
    ("make", "effect"),
    [(BENCHES["ordinary noise"], drift), (BENCHES["ordinary noise"], sprung), (BENCHES["a prior"], stiff)],
    ids=["drift under ordinary noise", "sprung under ordinary noise", "stiffer than modelled"],
)
def test_what_will_bring_most_is_predicted_to(make, effect):
    fitter = make(effect)
    none = nothing_found(fitter)
    scans = fitter.scan(none)[:16]
    brings = np.array([likelihood_ratio(none, with_candidate(fitter, none, one)) for one in scans])
    reach = np.array(predicted_likelihood_ratios(fitter, none, scans))
    assert brings.max() > 100.0
    assert reach[brings.argmax()] > 0.5 * brings.max()
    assert np.all(brings < ENTRY.bound_factor * np.maximum(reach, 5.0))
