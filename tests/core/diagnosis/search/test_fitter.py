"""A scan gives only what is physically admissible, and a hypothesis counts only what its rows determine."""

from dataclasses import replace
from typing import ClassVar

import numpy as np
import pytest

from tests.core.diagnosis.made_up import candidate, made_up, nothing_found, on_joint
from tests.core.diagnosis.scenes import Scene, fitter_of, linearised, measured_arm
from veritorque.core.diagnosis.causes.payload_change import PayloadChange
from veritorque.core.diagnosis.causes.registry import BY_ID
from veritorque.core.diagnosis.checks.holdout_outliers import with_other_holdout
from veritorque.core.diagnosis.search.fitter import HypothesisFitter
from veritorque.core.diagnosis.search.hypothesis import Hypothesis, ScoredCandidate
from veritorque.core.diagnosis.search.residuals import stiction_share

TRUE, NEAR = 7.0, 6.5
"""Waves per radian: what is there, and what resembles it."""
WAVE = on_joint(lambda state: np.sin(TRUE * state.position[:, 1]))
RATES = tuple({"rate": rate} for rate in (NEAR, TRUE))


def wave(state, scalars):
    return [np.sin(scalars["rate"] * state.position[:, 1])]


def scanned(allowed) -> ScoredCandidate:
    """Scan both waves, of which those that are given are physically admissible."""
    cause = made_up("wave", wave, RATES, allowed=lambda one: one["rate"] in allowed)
    fitter = fitter_of(measured_arm(WAVE), (cause,))
    (found,) = fitter.scan(nothing_found(fitter))
    return found


def test_of_all_admissible_scalars_a_scan_gives_the_likeliest():
    assert scanned({NEAR, TRUE}).candidate.scalars == {"rate": TRUE}


def test_admissible_scalars_go_before_likelier_ones_that_are_not():
    found = scanned({NEAR})
    assert found.candidate.scalars == {"rate": NEAR}
    assert found.statistic < scanned({TRUE}).statistic


def test_where_none_is_admissible_the_likeliest_scalars_are_given_all_the_same():
    """So that a report can say what would fit if it could be."""
    assert scanned(set()).candidate.scalars == {"rate": TRUE}


@pytest.fixture(scope="module")
def arm() -> Scene:
    return measured_arm()


def freedom(arm: Scene, *columns) -> int:
    """Count the directions of a cause with so many columns of the second joint's motion."""
    cause = made_up("columns", lambda state, scalars: [one(state) for one in columns])
    return fitter_of(arm, ()).fit((candidate(cause),)).freedom(0)


def sine(state):
    return np.sin(TRUE * state.position[:, 1])


def cosine(state):
    return np.cos(TRUE * state.position[:, 1])


def viscous(state):
    return state.velocity[:, 1]


def test_columns_of_their_own_are_directions_of_their_own(arm):
    assert [freedom(arm, sine), freedom(arm, sine, cosine)] == [1, 2]


def test_the_size_of_a_column_does_not_matter_to_what_the_rows_tell(arm):
    assert freedom(arm, sine, lambda state: 1e6 * cosine(state)) == 2
    assert freedom(arm, sine, lambda state: 1e-6 * cosine(state)) == 2


def test_a_column_that_is_there_twice_is_one_direction(arm):
    assert freedom(arm, sine, lambda state: -3.0 * sine(state)) == 1


def test_a_column_that_the_model_has_already_is_no_direction(arm):
    assert freedom(arm, sine, viscous) == 1


def test_a_cause_whose_columns_the_model_has_all_counts_as_one(arm):
    """A chance needs a direction; that it explains nothing is seen from its rise."""
    assert freedom(arm, viscous) == 1


def test_without_it_the_last_member_of_a_hypothesis_scores_what_the_hypothesis_found():
    """Regressing on what is left at the same noise is fitting both at once (Frisch & Waugh 1933)."""
    fitter = fitter_of(measured_arm(WAVE), ())
    member = candidate(made_up("wave", wave, RATES), {"rate": TRUE})
    whole = fitter.fit((member,))
    (found,) = fitter.scan(fitter.fit_without(whole, len(whole.members) - 1), [member])
    np.testing.assert_allclose(found.values, whole.fit.values[whole.columns_of(0)], rtol=1e-6)


def at_rest(torque) -> float:
    """Give the second joint's share of error at rest where a torque is there that the model lacks."""
    fitter = fitter_of(measured_arm(on_joint(torque)), ())
    return float(stiction_share(fitter, nothing_found(fitter))[1])


def test_what_is_missed_only_while_a_joint_turns_round_is_friction_at_rest():
    def slow(state):
        return np.abs(state.velocity[:, 1]) < 0.02

    assert at_rest(lambda state: 3.0 * slow(state) * np.sign(np.sin(state.time))) > 0.8


def test_what_is_missed_all_along_the_motion_is_not():
    assert at_rest(lambda state: 3.0 * np.sin(TRUE * state.position[:, 1])) < 0.2


def test_a_fitter_at_another_operating_point_leaves_the_first_as_it_was():
    fitter = fitter_of(measured_arm(WAVE), (BY_ID["torque_gain_nonlinear"],))
    none = nothing_found(fitter)
    suspected, found = fitter.candidates, fitter.scan(none)
    other = linearised_at_times(fitter, none, 2.0)
    assert not np.allclose(other.scan(none)[0].values, found[0].values)
    assert fitter.candidates == suspected
    assert np.array_equal(fitter.scan(none)[0].values, found[0].values)


def linearised_at_times(fitter: HypothesisFitter, none: Hypothesis, factor: float) -> HypothesisFitter:
    """Linearise at bodies so many times as heavy as those that were found."""
    return fitter.linearised_at(replace(none, fit=replace(none.fit, values=factor * none.fit.values)))


class Counted(type(BY_ID["torque_gain_nonlinear"])):
    """Suspect cubes of torque on many joints' worth of grid points, and count whose columns are built."""

    id = "counted"
    built: ClassVar[list[float]] = []

    def grid(self, at):
        return [{"point": float(point)} for point in range(40)]

    def term(self, at):
        self.built.append(at.scalars["point"])
        return super().term(at)


def built_anew(fitter: HypothesisFitter, none: Hypothesis) -> int:
    """Count the columns that a scan has to build at the present operating point."""
    Counted.built.clear()
    fitter.scan(none)
    return len(Counted.built)


def test_a_belief_that_hardly_differs_ranks_with_the_columns_of_the_one_before():
    fitter = fitter_of(measured_arm(WAVE), (Counted(),))
    none = nothing_found(fitter)
    built = []
    for factor in (1.0, 1.005, 1.1):
        fitter = linearised_at_times(fitter, none, factor)
        built.append(built_anew(fitter, none))
    # Three joints have forty points each; the best of each joint is built anew.
    assert built == [120, 3, 120]


def test_where_other_rows_are_held_out_scans_are_as_on_a_bench_of_its_own_without_building_columns_again():
    scene = measured_arm(WAVE)
    fitter = fitter_of(scene, (Counted(),))
    fitter.scan(nothing_found(fitter))
    dataset = with_other_holdout(scene.dataset)
    other, own = (
        linearised(fitter.with_dataset(dataset)),
        fitter_of(replace(scene, dataset=dataset), (Counted(),)),
    )
    none, alone = nothing_found(other), nothing_found(own)
    np.testing.assert_array_equal(none.fit.values, alone.fit.values)
    assert not np.array_equal(none.fit.values, fitter.fit(()).fit.values)
    # The best of each of three joints, at the present operating point.
    assert built_anew(other, none) == 3
    pairs = zip(other.scan(none), own.scan(alone), strict=True)
    assert all(one.candidate.key == theirs.candidate.key for one, theirs in pairs)


def test_an_operating_point_that_differs_on_one_joint_ranks_the_candidates_of_that_joint_alone_anew():
    fitter = fitter_of(measured_arm(WAVE), (Counted(),))
    none = nothing_found(fitter)
    fitter.scan(none)
    parameters = [fitter.plan.model.parameters[one] for one in fitter.plan.columns]
    (rubs,) = (place for place, one in enumerate(parameters) if (one.symbol, one.joint) == ("FC", 2))
    values = none.fit.values.copy()
    values[rubs] += 5.0
    fitter = fitter.linearised_at(replace(none, fit=replace(none.fit, values=values)))
    # The best of the other two joints are built anew.
    assert built_anew(fitter, none) == 40 + 2


def test_the_best_of_a_scan_are_scored_with_the_columns_of_the_operating_point():
    fitter = fitter_of(measured_arm(WAVE), (BY_ID["torque_gain_nonlinear"],))
    none = nothing_found(fitter)
    before = {one.candidate.key: one.values for one in fitter.scan(none)}
    fitter = linearised_at_times(fitter, none, 1.005)
    for one in fitter.scan(none):
        np.testing.assert_allclose(one.values, before[one.candidate.key] / 1.005**3, rtol=1e-6)


def test_what_is_fitted_has_the_columns_of_the_operating_point_however_little_that_differs():
    fitter = fitter_of(measured_arm(WAVE), (BY_ID["torque_gain_nonlinear"],))
    none = nothing_found(fitter)
    (first, *_) = (one.candidate for one in fitter.scan(none))
    before = fitter.fit_with(none, first).fit.values[-1]
    fitter = linearised_at_times(fitter, none, 1.01)
    after = fitter.fit_with(none, first).fit.values[-1]
    # A cube's coefficient falls by the cube of what its argument grows by.
    np.testing.assert_allclose(after, before / 1.01**3, rtol=0.02)
    assert after != before


def test_a_scan_is_made_once_for_a_hypothesis():
    fitter = fitter_of(measured_arm(WAVE), (BY_ID["torque_gain_nonlinear"],))
    none = nothing_found(fitter)
    assert fitter.scan(none) is fitter.scan(none)


def test_two_causes_of_one_name_are_both_candidates_at_the_same_joint():
    """As a load that came within the log, and one that is there since the reference."""
    fitter = fitter_of(measured_arm(), (PayloadChange(throughout=True), PayloadChange()))
    last = [one for one in fitter.candidates if one.site == (3,)]
    assert {one.cause.throughout for one in last} == {True, False}
    assert {one.cause.throughout for one in fitter.at.of_kind(last[0].key)} == {True, False}
    assert {one.cause.throughout for one in fitter.at.of(last[0].cause, (3,))} == {True}
