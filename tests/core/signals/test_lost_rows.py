"""A recorder that loses rows at random leaves a log that is used, or refused because of the lost rows."""

import numpy as np
import pytest

from tests.core.signals.motions import Multisine, log_of, turntables
from veritorque.core.errors import VeritorqueError
from veritorque.core.log.model import JointLog
from veritorque.core.study import IdentifyRequest, identify_in_full

TRUE = {"ZZR1": 0.4, "FV1": 0.8, "FC1": 1.5}


def lossy(rate_hz: float, lost: float, *, seconds: float = 60.0) -> JointLog:
    """Log a rotor with friction, of whose rows a share is lost at random."""
    rng = np.random.default_rng(5)
    motion = Multisine.random(rng, 1, highest_hz=1.0)
    time = np.arange(int(seconds * rate_hz)) / rate_hz
    time = time[rng.random(len(time)) >= lost]
    velocity, acceleration = (motion.derivative(time, order) for order in (1, 2))
    torque = TRUE["ZZR1"] * acceleration + TRUE["FV1"] * velocity + TRUE["FC1"] * np.sign(velocity)
    return log_of(time, motion.position(time), torque + 0.01 * rng.normal(size=torque.shape))


@pytest.mark.parametrize("rate_hz", [100.0, 250.0])
@pytest.mark.parametrize("lost", [0.2, 0.35, 0.45])
def test_rows_that_are_lost_at_random_bias_nothing(rate_hz, lost):
    request = IdentifyRequest(turntables(1), (lossy(rate_hz, lost),), {"conflicts": "report"})
    found = identify_in_full(request)
    values = dict(zip(found.base.names, found.estimate.base, strict=True))
    for name, value in TRUE.items():
        assert abs(values[name] / value - 1.0) < 0.01, name


@pytest.mark.parametrize(("lost", "seconds"), [(0.45, 20.0), (0.6, 60.0)])
def test_where_too_many_are_lost_the_refusal_says_so(lost, seconds):
    with pytest.raises(VeritorqueError, match="rows are missing") as refusal:
        identify_in_full(IdentifyRequest(turntables(1), (lossy(25.0, lost, seconds=seconds),), {}))
    assert "split" in str(refusal.value.evidence["gaps"])
    assert "record every row" in refusal.value.remedy
