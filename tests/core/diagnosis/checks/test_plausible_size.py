"""A size is implausible where the rest of the model cancels it; where its zero lies does not matter."""

import numpy as np
import pytest

from tests.core.diagnosis.made_up import JOINT, candidate, made_up, on_joint
from tests.core.diagnosis.scenes import Scene, fitter_of, measured_arm
from veritorque.core.diagnosis.causes.protocol import FittedCause
from veritorque.core.diagnosis.causes.registry import BY_ID
from veritorque.core.diagnosis.checks.plausible_size import has_known_size, has_plausible_size

STIFFNESS, FAR = 3.0, 200.0
"""N m/rad of a spring, and the angle, rad, that its column is counted from."""


@pytest.fixture(scope="module")
def sprung() -> Scene:
    return measured_arm(on_joint(lambda state: STIFFNESS * state.position[:, JOINT - 1]))


def sensible(arm: Scene, make) -> bool:
    cause = made_up("member", lambda state, scalars: make(state))
    fitter = fitter_of(arm, (cause,))
    return has_plausible_size(fitter, fitter.fit((candidate(cause),)), 0)


@pytest.mark.parametrize("zero", [0.0, FAR])
def test_a_springs_size_is_as_plausible_wherever_its_column_counts_from(sprung: Scene, zero: float):
    assert np.abs(sprung.dataset.torque[:, JOINT - 1]).max() < STIFFNESS * FAR
    assert sensible(sprung, lambda state: [state.position[:, JOINT - 1] - zero])


def test_how_a_friction_curve_is_split_does_not_matter(sprung: Scene):
    """Viscous friction of the opposite sign beside it is no more than another way to write the curve."""

    def make(state):
        spring, speed = state.position[:, JOINT - 1], state.velocity[:, JOINT - 1]
        return [spring + 100.0 * speed]

    assert sensible(sprung, make)


def test_a_torque_that_another_column_cancels_has_no_plausible_size(sprung: Scene):
    def make(state):
        spring, rotor = state.position[:, JOINT - 1], state.acceleration[:, JOINT - 1]
        return [spring + 1e4 * rotor]

    assert not sensible(sprung, make)


SHAPED = {"friction_temperature": 2, "torque_offset_drift": 1}
"""Causes with a time constant, and the number of their sizes."""


@pytest.mark.parametrize("name", SHAPED)
@pytest.mark.parametrize(("ratio", "known"), [(0.95, False), (5.0, True)])
def test_a_time_constant_does_not_stand_for_a_size_as_large_as_its_deviation(name: str, ratio: float, known):
    count = SHAPED[name]
    values = 0.2 * np.ones(count)
    covariance = np.diag((values / ratio) ** 2)
    for deviations in ({}, {"time_constant": 1.0}):
        solved = FittedCause((1,), values, covariance, {"time_constant": 9.0}, deviations)
        assert has_known_size(BY_ID[name], solved) is known
