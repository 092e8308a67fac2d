"""Hold the reported deviations to the scatter that repeated noise really causes."""

import json

import numpy as np
import pytest
from scipy.signal import lfilter

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.document.numbers import plain
from veritorque.core.dynamics.model import standard_model
from veritorque.core.estimate.system import weighted
from veritorque.core.precision.inference import Inference, infer, relative_deviation_percent
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan
from veritorque.core.regressor.observe import observe
from veritorque.core.signals.condition import condition
from veritorque.core.signals.recipe import FilterOptions
from veritorque.core.study import IdentifyRequest, identify

DRAWS = 60
"""Sixty draws tell one deviation to 9 %, and the mean over thirteen to about 4 %."""


def _noise(kind: str, rng: np.random.Generator, shape: tuple[int, int]) -> np.ndarray:
    white = 0.3 * rng.normal(size=shape)
    return white if kind == "white" else lfilter([1.0], [1.0, -0.9], white, axis=0)


class _Chain:
    """Send noisy logs of one planar motion through the whole chain, up to the weighted fit's precision."""

    def __init__(self) -> None:
        self.model = standard_model(planar_robot())
        self.base = base_model(self.model)
        self.truth = true_parameters(self.model)
        self.state = swing(2, seconds=15.0)
        self.plan = ColumnPlan(self.model, self.base.kept)

    def fit(self, noise: np.ndarray) -> tuple[np.ndarray, Inference, float]:
        log = log_of(self.model, self.truth, self.state, noise)
        motion = condition(log, self.model.robot, FilterOptions(cutoff_hz=10.0))
        seen = observe(self.plan, (motion,))
        system = weighted(seen.joint_factors(), seen.columns_of, len(self.base.kept))
        values = system.solved()
        precision = infer(system, seen.memory, seen.columns_of, values)
        return values, precision, system.rows


def _scatter(kind: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Give scattered, reported and memoryless deviations per parameter."""
    chain, rng = _Chain(), np.random.default_rng(17)
    values, reported, naive = [], [], []
    for _ in range(DRAWS):
        found, precision, _ = chain.fit(_noise(kind, rng, chain.state.position.shape))
        values.append(found)
        reported.append(precision.standard_deviation)
        # Weighted equations have variance one: without memory the covariance is the inverse of W'W.
        naive.append(np.sqrt(np.diag(np.linalg.solve(precision.information, np.eye(len(found))))))
    return np.std(values, axis=0, ddof=1), np.mean(reported, axis=0), np.mean(naive, axis=0)


@pytest.mark.parametrize("kind", ["white", "strongly autocorrelated"])
def test_reported_deviations_are_the_scatter_of_repeated_logs(kind):
    scattered, reported, naive = _scatter(kind)
    assert 0.8 <= np.mean(reported / scattered) <= 1.25
    assert np.all(reported / scattered > 0.5)
    assert np.all(reported / scattered < 2.0)
    if kind != "white":
        assert np.mean(naive / scattered) < 0.8


def test_the_memory_of_filtered_residuals_is_reported_per_joint():
    chain, rng = _Chain(), np.random.default_rng(3)
    factors = {
        kind: chain.fit(_noise(kind, rng, chain.state.position.shape))[1].memory_factor
        for kind in ("white", "strongly autocorrelated")
    }
    assert np.all(factors["strongly autocorrelated"] > 2.0 * factors["white"])


def _still_second_joint() -> dict[str, object]:
    model = standard_model(planar_robot())
    state = swing(2)
    for series in (state.position, state.velocity, state.acceleration):
        series[:, 1] = 0.0
    rng = np.random.default_rng(0)
    log = log_of(model, true_parameters(model), state, 0.05 * rng.normal(size=state.position.shape))
    request = IdentifyRequest(model.robot, (log,), {"bootstrap": {"draws": 0}})
    return identify(request)


def test_what_the_motion_leaves_open_has_an_infinite_deviation_and_null_in_the_document():
    document = _still_second_joint()
    rows = {row["name"]: row for row in document["base_parameters"]}
    for name in ("IA2", "FV2", "FC2", "ZZ2"):
        assert rows[name]["standard_deviation"] is None, name
        assert rows[name]["relative_deviation_percent"] is None, name
        assert not rows[name]["essential"], name
    for name in ("FV1", "FC1", "OFF1"):
        assert rows[name]["standard_deviation"] > 0.0
    json.dumps(document, allow_nan=False)


def test_a_relative_deviation_of_nothing_is_open():
    assert relative_deviation_percent(np.array([0.0, 2.0]), np.array([0.1, np.inf])).tolist() == [
        np.inf,
        np.inf,
    ]
    assert plain(relative_deviation_percent(np.array([0.0]), np.array([0.0]))) == [None]


def test_a_perfect_fit_has_no_deviation():
    chain = _Chain()
    _, precision, _ = chain.fit(np.zeros_like(chain.state.position))
    _, noisy, _ = chain.fit(_noise("white", np.random.default_rng(0), chain.state.position.shape))
    assert np.all(precision.standard_deviation < 0.2 * noisy.standard_deviation)
