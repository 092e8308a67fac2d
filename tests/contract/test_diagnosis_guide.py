"""Keep the guide to diagnoses true: it explains every verdict and every field that a reader meets."""

import re
from pathlib import Path
from typing import get_args

import pytest
from pydantic import BaseModel

from tests.core.dynamics.every_term import cures_by_cause
from veritorque.app.schemas import diagnosis as contract
from veritorque.core.diagnosis.result import Verdict
from veritorque.core.diagnosis.thresholds.checks import VERDICT
from veritorque.core.diagnosis.thresholds.search import ENTRY, SEARCH, SELECTION

ROOT = Path(__file__).parents[2]
GUIDE = (ROOT / "docs" / "diagnosis.md").read_text(encoding="utf-8")
STORY = (ROOT / "core" / "study.py", ROOT / "core" / "diagnosis" / "diagnose.py")
NAMED = set(re.findall(r"\w+", " ".join(re.findall(r"`([^`\n]+)`", GUIDE))))
MODELS = [
    one
    for one in vars(contract).values()
    if isinstance(one, type) and issubclass(one, BaseModel) and one.__module__ == contract.__name__
]
IN_AN_IDENTIFICATION = {"JointFit"}
"""Explained with the results of either kind of job."""


def row(name: str) -> str:
    (found,) = re.findall(rf"^\| `{name}` \|.*$", GUIDE, re.MULTILINE)
    return found


def test_the_guide_says_of_every_cause_that_is_an_input_to_the_simulation_which_kind_it_is():
    channel, past = re.findall(
        r"^- (?:What only the torque channel|A torque that depends).*?\.$", GUIDE, re.MULTILINE | re.DOTALL
    )
    terms = [(cause.id, term) for cause, term in cures_by_cause()]
    assert set(re.findall(r"`(\w+)`", channel)) == {name for name, term in terms if term.channel}
    assert set(re.findall(r"`(\w+)`", past)) == {
        name for name, term in terms if term.has_memory and not term.channel
    }


def test_every_verdict_is_explained():
    assert all(row(verdict) for verdict in get_args(Verdict))


@pytest.mark.parametrize("model", MODELS, ids=lambda one: one.__name__)
def test_every_field_of_a_diagnosis_is_explained(model):
    if model.__name__ not in IN_AN_IDENTIFICATION:
        assert set(model.model_fields) <= NAMED


def test_the_numbers_that_decide_are_those_of_the_code():
    assert SELECTION.undecided == 6.0
    assert "differ by less than 6" in GUIDE
    assert ENTRY.level == 1e-4
    assert "one false cause in ten thousand logs" in GUIDE
    assert SEARCH.causes == 5
    assert "Five at most" in GUIDE
    assert VERDICT.unexplained_share == 0.03
    assert "at least 3 % is predictable" in GUIDE


def test_the_stages_are_those_that_a_diagnosis_tells():
    told = set(re.findall(r'tell\("([^"]+)"', "".join(path.read_text() for path in STORY)))
    assert {stage for stage in told if f"`{stage}`" not in GUIDE} <= {"smooth"}
