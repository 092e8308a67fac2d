"""The stiffness of an elastic joint is that of its resonance: a load that swings has another one."""

from functools import cache

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.signal import lsim

from tests.core.diagnosis.scenes import Scene, measured_arm
from tests.plant import second
from veritorque.core.diagnosis.causes.joint_elasticity import JointElasticity
from veritorque.core.diagnosis.causes.protocol import FittedCause, Setting
from veritorque.core.diagnosis.causes.time_delay import TimeDelay
from veritorque.core.diagnosis.checks.spring_resonance import contradicts_resonance, resonance_evidence
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE
from veritorque.core.dynamics.gear import Gear
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.study import IdentifyRequest, diagnose

SWING_HZ, DAMPING, LOAD, REACH = 3.0, 0.05, 0.5, 0.4
"""Rate, damping ratio and mass (kg) of a load that swings at so many m from the second joint."""


def recorded(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Give time, position and torque of a planar arm, by its closed equations, that carries such a load."""
    rng = np.random.default_rng([seed, 5])
    body, reference = second._body(rng), second._reference(rng, 0.8)
    time = np.arange(0.0, second.SECONDS, 1.0 / second.RATE_HZ)
    angle = np.array([reference.at(instant)[0] for instant in time])
    rate, bend = (CubicSpline(time, angle)(time, order) for order in (1, 2))
    parts = zip(angle, rate, bend, strict=True)
    torque = np.array([body.mass(q) @ a + body.bias(q, v) for q, v, a in parts])
    torque += body.viscous * rate + body.coulomb * np.tanh(rate / 1e-3) + _of_load(time, angle)
    return time, angle, torque + 0.005 * torque.std(axis=0) * rng.normal(size=torque.shape)


def _of_load(time: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Give the torque against the pull of the load, which a spring holds at the end of the arm."""
    first, last = second.LINK * np.exp(1j * angle[:, 0]), REACH * np.exp(1j * angle.sum(axis=1))
    moved = CubicSpline(time, first + last)(time, 2)
    own = 2.0 * np.pi * SWING_HZ
    spring = ([2.0 * DAMPING * own, own**2], [1.0, 2.0 * DAMPING * own, own**2])
    swung = lsim(spring, moved.real, time)[1] + 1j * lsim(spring, moved.imag, time)[1]
    force = LOAD * (swung + 1j * second.GRAVITY)
    levers = (1j * (first + last), 1j * last)
    return np.column_stack([(lever * np.conj(force)).real for lever in levers])


@pytest.mark.parametrize("seed", [2])
def test_a_load_that_swings_is_no_elastic_joint_and_what_it_leaves_no_other_cause(seed):
    log = log_from_arrays("swinging", *recorded(seed))
    found = diagnose(IdentifyRequest(second.robot(), (log,), {"bootstrap": {"draws": 0}}))["diagnosis"]
    assert JointElasticity.id in [each["cause"] for each in found["findings"]]
    assert all(each["confidence"] <= CONFIDENCE.doubtful for each in found["findings"])
    assert found["verdict"] == "unexplained"


@pytest.mark.parametrize(
    ("times", "resonance_deviation", "contradicted"),
    [(1.0, 0.0, False), (1.3, 0.0, False), (2.0, 0.0, True), (0.5, 0.0, True), (2.0, 0.4, False)],
    ids=["its own", "nearly", "twice", "half", "uncertain"],
)
def test_a_stiffness_is_that_of_resonance_and_inertia(times, resonance_deviation, contradicted):
    look = arm()
    inertia = float(np.mean(Gear(look.operating_point, 2).inertia(look.dataset.state)))
    stiffness = times * (2.0 * np.pi * 5.0) ** 2 * inertia
    solved = FittedCause(
        (2,),
        np.array([1.0 / stiffness]),
        np.array([[(0.1 / stiffness) ** 2]]),
        {"resonance_hz": 5.0},
        {"resonance_hz": resonance_deviation * 5.0},
    )
    at = Setting(look.dataset, look.operating_point, (2,), {"resonance_hz": 5.0})
    evidence = resonance_evidence(JointElasticity.id, at, solved)
    assert evidence[0].value == pytest.approx(times)
    assert contradicts_resonance(evidence, solved) is contradicted
    assert resonance_evidence(TimeDelay.id, at, solved) == ()


@cache
def arm() -> Scene:
    return measured_arm()
