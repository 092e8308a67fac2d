"""A cause whose gain is in doubt joins the model where simulated motion verifies it."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.diagnosis.scenes import measured_arm, skew_arm
from tests.core.diagnosis.test_diagnose import diagnosed, hidden
from veritorque.core import study
from veritorque.core.diagnosis import diagnose
from veritorque.core.diagnosis.result import Diagnosis
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE
from veritorque.core.errors import SolverError
from veritorque.core.extension import extend
from veritorque.core.extension.result import Extension
from veritorque.core.identification import identify
from veritorque.core.study import IdentifyRequest, diagnose_in_full

HARMLESS, HIDDEN = measured_arm(), measured_arm(hidden)


def in_doubt(found: Diagnosis) -> Diagnosis:
    """Let the search have been less sure of what it found."""
    (one,) = found.findings
    return replace(found, findings=(replace(one, gain=replace(one.gain, interval_95=(-1.0, 9.0))),))


def studied(monkeypatch: pytest.MonkeyPatch, scene, progress=None) -> Extension:
    """Diagnose a scene where the search doubts that friction of joint 2 differs between the directions."""
    monkeypatch.setattr(diagnose, "diagnose", lambda *_: in_doubt(diagnosed(hidden)))
    logs = (scene.dataset.motions[0].log,)
    return diagnose_in_full(IdentifyRequest(skew_arm(), logs, {"bootstrap": {"draws": 0}}), progress)


def test_a_cause_in_doubt_joins_the_model_where_held_out_motion_is_better_predicted(monkeypatch):
    found = studied(monkeypatch, HIDDEN)
    (one,) = found.diagnosis.findings
    shown = one.evidence[-1]
    (gain,) = (gain for gain in found.gains if gain.joint == 2)
    assert one.verified
    assert one.confidence == diagnosed(hidden).findings[0].confidence
    assert "joint 2" in shown.statement
    np.testing.assert_allclose(shown.value, gain.improvement_percent, rtol=0.05)
    assert gain.interval_95[0] > 0.0


def test_what_was_verified_is_not_identified_once_more(monkeypatch):
    fits = []

    def fitted(*asked):
        fits.append(identify.fit(*asked))
        return fits[-1]

    monkeypatch.setattr(study, "fit", fitted)
    monkeypatch.setattr(extend, "fit", fitted)
    found = studied(monkeypatch, HIDDEN)
    assert len(fits) == 3  # the plain model, as it is with what is beyond doubt, and with the cause in doubt
    assert found.after.observation is fits[-1].observation
    assert found.after.estimate is fits[-1].estimate


def test_verifying_is_reported_between_the_search_and_the_correction(monkeypatch):
    told = []
    studied(monkeypatch, HIDDEN, lambda stage, done: told.append((stage, done)))
    stages = [stage for stage, _ in told]
    assert "verify" in stages
    assert stages[stages.index("verify") :].count("simulate") == 1
    assert [done for _, done in told] == sorted(done for _, done in told)


def test_a_cause_in_doubt_joins_no_model_where_it_gains_nothing(monkeypatch):
    found = studied(monkeypatch, HARMLESS)
    assert found.after is None
    assert not found.diagnosis.findings[0].verified
    mine, before = found.diagnosis.findings[0], diagnosed(hidden).findings[0]
    assert mine.confidence == CONFIDENCE.doubtful < before.confidence
    assert len(mine.evidence) == len(before.evidence)


def test_a_cause_in_doubt_with_which_there_is_no_answer_joins_no_model(monkeypatch):
    plain = iter([identify.fit])

    def unsolved(*asked):
        for first in plain:
            return first(*asked)
        raise SolverError("it has no answer", evidence={}, remedy="none")

    monkeypatch.setattr(study, "fit", unsolved)
    monkeypatch.setattr(extend, "fit", unsolved)
    found = studied(monkeypatch, HIDDEN)
    assert found.after is None
    assert not found.diagnosis.findings[0].verified
