"""Keep the guide to diagnoses true: it explains every verdict and every field that a reader meets."""

import re
from pathlib import Path
from typing import get_args

from app.schemas.diagnosis import Diagnosis, Finding, Unexplained
from core.diagnosis.diagnosis import Verdict

GUIDE = (Path(__file__).parents[2] / "docs" / "diagnosis.md").read_text(encoding="utf-8")
NAMED = set(re.findall(r"`\"?(\w+)\"?`", GUIDE))


def row(name: str) -> str:
    (found,) = re.findall(rf"^\| `{name}` \|.*$", GUIDE, re.MULTILINE)
    return found


def test_every_verdict_is_explained():
    assert all(row(verdict) for verdict in get_args(Verdict))


def test_every_field_of_a_finding_and_of_what_is_left_is_explained():
    shown_elsewhere = {"title", "evidence", "rms_residual"}
    assert (set(Finding.model_fields) | set(Unexplained.model_fields)) - NAMED <= shown_elsewhere
    assert set(Diagnosis.model_fields) - NAMED <= {"before", "after"}
