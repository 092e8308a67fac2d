"""Hold columns that are filtered once for several terms to those of every term alone."""

import numpy as np

from tests.core.diagnosis.scenes import eventful_scene
from veritorque.core.diagnosis.causes.registry import CAUSES
from veritorque.core.diagnosis.search.candidates import Candidates
from veritorque.core.dynamics.terms.unnamed_pattern import FACTORS, Trace

NUMBERS = {"speeds": (1.0, 2.0), "clock": (0.7,), "levels": (3.0, 5.0), "swing": (1.5,), "friction": (4.0,)}
PATTERNS = [*NUMBERS.items(), *(("angle", (2.0, 3.0, float(factor))) for factor in range(len(FACTORS)))]


def test_a_pattern_has_the_columns_of_its_own_joint_also_where_others_share_them():
    dataset = eventful_scene().dataset
    terms = [Trace(joint, name, numbers) for name, numbers in PATTERNS for joint in (1, 3)]
    for term, together in zip(terms, dataset.columns(terms), strict=True):
        (alone,) = dataset.columns([term])
        assert list(together) == list(alone) == [term.joint - 1]
        np.testing.assert_allclose(together[term.joint - 1], alone[term.joint - 1], rtol=1e-12, atol=1e-12)


def test_every_parameter_of_a_candidate_acts_on_a_joint():
    scene = eventful_scene()
    found = Candidates(CAUSES, scene.dataset, scene.dataset, scene.operating_point)
    candidates = [each for cause, site in found.lasting for each in found.of(cause, site)[:1]]
    terms = [each.term(scene.dataset, scene.operating_point) for each in candidates]
    assert len(terms) > 30
    for term in terms:
        acting = {parameter for _, parameter in term.entries(scene.dataset.robot)}
        assert sorted(acting) == list(range(len(term.parameters(scene.dataset.robot)))), term
