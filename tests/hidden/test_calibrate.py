import numpy as np
import pytest

from tests.hidden.calibrate import Sample, against, brier, fit, reliability
from veritorque.core.diagnosis.checks.confidence import CALIBRATION, Calibration, coefficients, probability

TRUE = Calibration(offset=-0.5, per_strength=1.2, per_lead=0.4, per_gain=0.3)


def findings(count, seed):
    """Draw findings that are right with the probability that a known calibration gives."""
    rng = np.random.default_rng(seed)
    drawn = rng.uniform([-1.0, -1.0, -1.0], [2.0, 4.0, 1.0], (count, 3))
    evidence = [(float(strength), float(lead), float(np.sign(gain))) for strength, lead, gain in drawn]
    return [Sample(one, bool(rng.random() < probability(TRUE, one))) for one in evidence]


def test_the_calibration_that_findings_were_drawn_from_is_found():
    found = fit(findings(20_000, 0))
    for name, value in coefficients(TRUE).items():
        assert coefficients(found)[name] == pytest.approx(value, abs=0.1)


def test_a_calibrated_confidence_is_the_share_of_right_findings():
    found, others = fit(findings(20_000, 0)), findings(20_000, 1)
    for row in reliability(found, others):
        assert row["right"] == pytest.approx(row["confidence"], abs=0.03)
    assert brier(found, others) < brier(Calibration(3.0, 0.0, 0.0, 0.0), others)


def test_the_file_that_the_code_reads_states_every_coefficient():
    read = Calibration.read()
    assert all(np.isfinite(list(coefficients(read).values())))
    assert 0.0 < probability(read, (-1.0, -1.0, -1.0)) < probability(read, (2.0, 4.0, 1.0)) < 1.0
    assert CALIBRATION.name == "confidence.json"


def test_no_evidence_counts_against_a_finding():
    assert against(Calibration.read()) == []
    assert against(Calibration(3.0, 1.0, -0.3, 0.5)) == ["per_lead"]
