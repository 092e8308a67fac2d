"""Torques between uneven stamps pass through a reversal gradually, and so does the friction of the fit."""

import numpy as np
import pytest

from tests.core.signals.motions import Multisine, jittered, log_of, turntables
from veritorque.core.study import IdentifyRequest, identify_in_full

INERTIA, VISCOUS, COULOMB = 0.4, 0.8, 1.5


@pytest.mark.parametrize("rate_hz", [25.0, 33.0, 100.0])
@pytest.mark.parametrize("scatter", [0.0, 0.3])
def test_friction_is_as_true_on_uneven_stamps_as_on_even_ones(rate_hz, scatter):
    rng = np.random.default_rng(5)
    motion = Multisine.random(rng, 1, highest_hz=1.5)
    time = jittered(rng, int(120.0 * rate_hz), rate_hz, scatter)
    velocity, acceleration = (motion.derivative(time, order) for order in (1, 2))
    torque = INERTIA * acceleration + VISCOUS * velocity + COULOMB * np.sign(velocity)
    log = log_of(time, motion.position(time), torque + 0.01 * rng.normal(size=torque.shape))
    found = identify_in_full(IdentifyRequest(turntables(1), (log,), {"conflicts": "report"}))
    values = dict(zip(found.base.names, found.estimate.base, strict=True))
    assert abs(values["FC1"] / COULOMB - 1.0) < 0.005
    assert abs(values["FV1"] / VISCOUS - 1.0) < 0.01
