"""A finding's row says everything that the finding knows, in the names that clients are written against."""

import json

import numpy as np
import pytest

from veritorque.app.schemas.diagnosis import Finding as FindingSchema
from veritorque.app.schemas.diagnosis import NotIdentifiable as NotIdentifiableSchema
from veritorque.core.diagnosis.causes.protocol import Quantity
from veritorque.core.diagnosis.causes.registry import BY_ID
from veritorque.core.diagnosis.result import Alternative, Curve, Evidence, Finding, Gain, NotIdentifiable
from veritorque.core.document.finding import finding_row, not_identifiable_row, title_of
from veritorque.core.document.numbers import plain


def finding(**changes):
    bins = np.arange(3.0)
    whole = {
        "cause": "torque_ripple",
        "title": "Torque ripple",
        "joints": (4,),
        "cure": "term",
        "statement": "Joint 4's torque ripples",
        "confidence": 0.9,
        "p_value": 1e-8,
        "explained_fraction": 0.4,
        "quantities": (Quantity("amplitude", 4, "N m", -0.5, 0.05), Quantity("phase", 4, "rad", 0.0, 0.1)),
        "evidence": (Evidence("Rise", "likelihood ratio", 40.0),),
        "ambiguous_with": (Alternative("encoder_eccentricity", (4,), 38.0, "alike", "add a payload"),),
        "refuted": (Alternative("torque_gain", (4,), 9.0, "less", ""),),
        "gain": Gain(np.ones(4), np.full(4, 0.5), np.full(4, 50.0), 50.0, (40.0, 60.0)),
        "curve": Curve("position", "rad", 4, *([bins] * 5), direction=np.zeros(3)),
        "member": None,
    } | changes
    return Finding(**whole)


def row(one):
    return json.loads(json.dumps(plain(finding_row(one)), allow_nan=False))


def test_a_finding_follows_the_contract():
    FindingSchema.model_validate(row(finding()))
    FindingSchema.model_validate(row(finding(gain=None, curve=None, quantities=(), joints=())))


def test_every_number_of_a_finding_stands_beside_its_unit_and_its_uncertainty():
    first, second = row(finding())["parameters"]
    assert first == {
        "name": "amplitude",
        "joint": 4,
        "unit": "N m",
        "value": -0.5,
        "standard_deviation": 0.05,
        "relative_deviation_percent": 10.0,
    }
    assert second["relative_deviation_percent"] is None  # of a value of zero


def test_what_is_not_finite_is_null():
    shown = row(finding(quantities=(Quantity("distance", 4, "rad", 1.0, np.inf),)))
    assert shown["parameters"][0]["standard_deviation"] is None
    assert shown["parameters"][0]["relative_deviation_percent"] is None


def test_alternatives_are_named_in_words_with_the_experiment_that_separates_them():
    (undecided,) = row(finding())["ambiguous_with"]
    assert (undecided["title"], undecided["separating_experiment"]) == (
        "Encoder eccentricity",
        "add a payload",
    )


def test_what_acts_on_other_joints_only_is_not_called_refuted():
    alternatives = tuple(
        Alternative("torque_gain", joints, 9.0, "less", "") for joints in ((4,), (2,), (), (3, 4))
    )
    assert [one["joints"] for one in row(finding(refuted=alternatives))["refuted"]] == [[4], [], [3, 4]]


def test_a_gain_is_told_per_joint_with_its_interval():
    shown = row(finding())["gain"]
    assert shown["held_out"] is True
    assert shown["rms_residual_before"] == [1.0] * 4
    assert shown["interval_95"] == [40.0, 60.0]


@pytest.mark.parametrize("cause", BY_ID)
def test_every_cause_has_a_title(cause):
    assert title_of(cause) == BY_ID[cause].title


def test_a_cause_that_could_not_show_follows_the_contract():
    shown = plain(not_identifiable_row(NotIdentifiable("torque_gain", (6,), "spanned", "a weighed payload")))
    NotIdentifiableSchema.model_validate(json.loads(json.dumps(shown)))
