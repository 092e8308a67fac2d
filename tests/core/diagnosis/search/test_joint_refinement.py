"""Hold the joint refinement of a hypothesis to its law: its operating point may not undo what was found."""

import numpy as np
import pytest

from tests.core.diagnosis.made_up import candidate, nothing_found
from tests.core.diagnosis.scenes import fitter_of, measured_arm
from tests.core.diagnosis.waves import BuiltOn, WaveCause, wave_cause, wave_effect
from veritorque.core.diagnosis.search.joint_refinement import refine_jointly
from veritorque.core.diagnosis.search.likelihood_ratio import likelihood_ratio
from veritorque.core.diagnosis.search.state import SearchState
from veritorque.core.diagnosis.search.stepwise import search_stepwise

QUICK, QUICKER, SLOW, OTHER = 7.0, 11.0, 4.5, 4.0


class Fickle(WaveCause):
    """Take one wave for a candidate, and another one once the model is linearised at it."""

    id = title = "fickle"

    def term(self, at):
        believes = any(isinstance(one, BuiltOn) for one, _ in at.operating_point.joined)
        return BuiltOn(at.joint, {SLOW if believes else QUICK: 1.0}, at.operating_point)


@pytest.mark.parametrize(
    ("share", "kept"), [(0.0, QUICK), (1.0, SLOW)], ids=["takes what it brings", "is worth it"]
)
def test_a_search_is_linearised_at_what_is_found_unless_that_takes_what_it_brings(share, kept):
    cause = Fickle()
    fitter = fitter_of(measured_arm(wave_effect({QUICK: 0.3, SLOW: share})), (cause,))
    none = nothing_found(fitter)
    found = fitter.fit_with(none, candidate(cause))
    refined = refine_jointly(SearchState(fitter, none, found))
    fitter, now = refined.fitter, refined.chosen
    assert likelihood_ratio(none, now) > 0.5 * likelihood_ratio(none, found) > 5.0
    (columns,) = fitter.columns(now.members)
    angle = fitter.dataset.state.position[:, 1]
    like = [abs(np.corrcoef(columns[1][:, 0], np.sin(rate * angle))[0, 1]) for rate in (QUICK, SLOW)]
    assert (QUICK, SLOW)[int(np.argmax(like))] == kept


def test_the_operating_point_holds_nothing_that_was_swapped_out_even_if_the_other_is_left_alone():
    nearly = wave_cause("nearly", {QUICK: 1.0, QUICKER: 1.0, OTHER: 0.5})
    causes = (Fickle(), wave_cause("quicker", {QUICKER: 1.0}), nearly)
    fitter = fitter_of(measured_arm(wave_effect({QUICK: 0.6, QUICKER: 0.6})), causes)
    found = search_stepwise(fitter)
    assert ("swapped", "fickle") in [(step.action, step.candidate.cause.id) for step in found.steps]
    assert [one.cause.id for one in found.chosen.members] == ["quicker", "fickle"]
    (operating_point,) = [term.waves for term, _ in found.fitter.operating_point.joined]
    assert operating_point == {QUICKER: 1.0}
