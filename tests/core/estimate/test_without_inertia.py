"""A model without inertia has no motion to simulate: whoever simulates refuses it by name."""

from functools import cache

import numpy as np
import pytest

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import OptionError
from veritorque.core.simulation.closed_loop.free_windows import FreeWindows
from veritorque.core.study import IdentifyRequest, identify_in_full

MODEL = standard_model(planar_robot())
LOG = log_of(MODEL, true_parameters(MODEL), swing(2))


@cache
def found(estimator: str, *terms: str) -> np.ndarray:
    asked = {"estimator": estimator, "bootstrap": {"draws": 0}, "terms": list(terms)}
    return identify_in_full(IdentifyRequest(MODEL.robot, (LOG,), asked)).estimate.base


@pytest.mark.parametrize("terms", [("coulomb", "viscous"), ("viscous", "offset")])
@pytest.mark.parametrize("estimator", ["iv", "piv", "didim", "clie", "cloe", "oe", "ekf", "srukf"])
def test_it_is_refused_where_motion_is_simulated_and_fitted_where_it_is_not(estimator, terms):
    assert len(found("sdp", *terms)) == 4
    with pytest.raises(OptionError, match="without inertia"):
        found(estimator, *terms)


def test_nothing_is_simulated_before_it_is_refused(monkeypatch):
    """Free motion over short windows of such a model took seconds, and was refused afterwards."""

    def simulate(*_):
        raise AssertionError("simulated")

    monkeypatch.setattr(FreeWindows, "rows", simulate)
    with pytest.raises(OptionError, match="without inertia"):
        found("oe", "coulomb", "viscous")
