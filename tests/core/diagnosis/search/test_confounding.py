"""A short push beside a far larger cause is a part of that one, unless its p-value is very small."""

import numpy as np
import pytest

from tests.core.diagnosis.made_up import candidate, made_up, nothing_found, on_joint
from tests.core.diagnosis.scenes import fitter_of, measured_arm
from veritorque.core.diagnosis.search.confounding import is_masked, keeps_beside
from veritorque.core.diagnosis.search.hypothesis import Candidate
from veritorque.core.diagnosis.search.likelihood_ratio import likelihood_ratio


def waves(state):
    return np.sin(7.0 * state.position[:, 1])


def push(state):
    return 1.0 * (np.abs(state.time - 5.0) < 0.3)


ALWAYS = made_up("always", lambda state, scalars: [waves(state)])
ONCE = made_up("once", lambda state, scalars: [push(state)], transient=True)
WEAK, STRONG = 0.03, 50.0
"""N m, of what acts always; the noise is 0.05 N m."""
BY_CHANCE, CLEAR = 0.06, 0.08
"""N m, of the push: chances of 1e-24 and 1e-33."""


@pytest.mark.parametrize(
    ("always", "once", "far_less", "expected"),
    [(WEAK, BY_CHANCE, False, False), (STRONG, BY_CHANCE, True, True), (STRONG, CLEAR, True, False)],
)
def test_a_push_is_told_from_what_a_strong_cause_leaves(always, once, far_less, expected):
    effect = on_joint(lambda state: always * waves(state) + once * push(state))
    fitter = fitter_of(measured_arm(effect), ())
    none = nothing_found(fitter)
    less, other = (fitter.fit_with(none, candidate(one)) for one in (ALWAYS, ONCE))
    both = fitter.fit_with(less, candidate(ONCE))
    assert (likelihood_ratio(less, both) < 0.05 * likelihood_ratio(other, both)) is far_less
    assert is_masked(fitter, both, 1, less) is expected


def test_what_acts_on_another_joint_is_no_alternative_though_noise_has_absorbed_most_of_it():
    """A likelihood ratio is at the noise that a candidate yields, a score at one that has absorbed it."""

    def swing(state):
        return 5.0 * np.sin(2.0 * np.pi * 8.0 * state.time)

    def effect(state):
        out = on_joint(waves)(state)
        out[:, 2] += swing(state)
        return out

    other = made_up("other", lambda state, scalars: [swing(state)])
    there = Candidate(other, (3,), {}, 1.0)
    fitter = fitter_of(measured_arm(effect), ())
    none = nothing_found(fitter)
    own = fitter.fit_with(none, candidate(ALWAYS))
    alternative = fitter.fit_with(none, there)
    alone = likelihood_ratio(none, alternative)
    beside = fitter.scan(own, [there])[0].statistic
    assert beside < 0.5 * alone
    assert keeps_beside(fitter, none, own, there, alone)
    same = candidate(made_up("same", lambda state, scalars: [waves(state) + 0.01 * swing(state)]))
    assert not keeps_beside(fitter, none, own, same, likelihood_ratio(none, fitter.fit_with(none, same)))
