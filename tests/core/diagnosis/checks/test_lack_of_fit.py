"""Hide what is in no list: the search says what the residual follows, and is silent where nothing is left."""

import numpy as np
import pytest
from scipy.signal import lsim

from tests.core.diagnosis.made_up import JOINT, candidate, made_up, nothing_found, on_joint
from tests.core.diagnosis.scenes import Effect, Scene, fitter_of, look_at_arm, measured_arm, skew_arm
from tests.core.estimate.worlds import true_parameters
from veritorque.core.diagnosis.checks.lack_of_fit import best_unnamed_pattern, unnamed_candidates
from veritorque.core.diagnosis.search.hypothesis import Hypothesis
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.model import whole_rows

RHYTHM = 0.4
"""Repetitions of something beside the robot, Hz."""
RELEASED = 7.3
"""When a brake lets go, s."""
SWING, DAMPING = 1.9, 0.05
"""Rate of something loose on the link, Hz, and its damping ratio."""


def product(state):
    return 0.3 * state.velocity[:, 0] * state.velocity[:, 2]


def wave_of_another_joint(state):
    return 0.1 * np.cos(2.0 * state.position[:, 0]) * np.sign(state.velocity[:, 1])


def beat(state):
    return 0.1 * np.sin(2.0 * np.pi * RHYTHM * state.time) ** 3


def swing(state):
    """Let something that hangs loose swing as the joint shakes it."""
    rate = 2.0 * np.pi * SWING
    _, deflection, _ = lsim(
        ([-1.0], [1.0, 2.0 * DAMPING * rate, rate**2]), state.acceleration[:, 1], state.time
    )
    return 5.0 * deflection


def brake_that_lets_go(state):
    """Drag a brake for some time, which no warm-up ends at once."""
    return np.where(state.time < RELEASED, np.sign(state.velocity[:, 1]), 0.0)


def shares_of_other_torques(state):
    """Let the channel read a little of the other joints' torques."""
    model = standard_model(skew_arm())
    return model.torque(true_parameters(model), state)[:, [0, 2]] @ np.array([0.01, -0.03])


WORDS = {
    shares_of_other_torques: "shares of the other joints' torques",
    product: "the product of the speeds of joints 1 and 3",
    wave_of_another_joint: "a wave over joint 1's angle (2 per revolution) with the sign of its own speed",
    beat: "a period of 2.5 s, independent of the motion",
    brake_that_lets_go: "its own friction, which switches at 7.3 s",
    swing: "an oscillation at about 1.8 Hz, independent of the motion",
}


def found_beside_nothing(effect: Effect | None, seed: int) -> Hypothesis | None:
    return found_in(measured_arm(effect, seed=seed))


def found_in(scene: Scene) -> Hypothesis | None:
    fitter = fitter_of(scene, ())
    return best_unnamed_pattern(fitter, nothing_found(fitter), unnamed_candidates(fitter))


@pytest.mark.parametrize("seed", [6, 7])
@pytest.mark.parametrize("torque", WORDS, ids=lambda one: one.__name__)
def test_a_pattern_without_a_name_is_told_with_its_joint_and_what_it_follows(torque, seed):
    found = found_beside_nothing(on_joint(torque), seed)
    last = found.members[-1]
    statement = last.cause.statement(found.solved(0))
    assert last.site == (JOINT,)
    assert statement.startswith(f"The residual of joint {JOINT} follows ")
    assert WORDS[torque] in statement


@pytest.mark.parametrize("share", [-0.03, 0.03])
def test_positions_that_are_read_on_another_scale_are_told_with_their_joint(share):
    dataset = measured_arm().dataset
    scale = np.where(np.arange(dataset.joints) == JOINT - 1, 1.0 + share, 1.0)
    rows = whole_rows(dataset.motions[0].log)
    found = found_in(look_at_arm(rows.position * scale, rows.torque))
    last = found.members[-1]
    assert last.site == (JOINT,)
    assert "a scale of its positions" in last.cause.statement(found.solved(0))


@pytest.mark.parametrize("seed", range(8))
def test_nothing_is_told_of_a_residual_that_is_noise(seed):
    assert found_beside_nothing(None, seed) is None


def test_nothing_is_left_to_tell_once_a_cause_with_the_very_column_is_there():
    cause = made_up("product", lambda state, scalars: [product(state)])
    fitter = fitter_of(measured_arm(on_joint(product)), (cause,))
    nothing_found(fitter)
    explained = fitter.fit((candidate(cause),))
    assert best_unnamed_pattern(fitter, explained, unnamed_candidates(fitter)) is None


def test_a_pattern_reports_no_numbers_since_they_would_mean_nothing_elsewhere():
    found = found_beside_nothing(on_joint(product), 6)
    assert found.members[-1].cause.quantities(found.solved(0)) == ()
