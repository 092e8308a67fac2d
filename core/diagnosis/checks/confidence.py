"""Give the confidence that a cause was found: a logistic model of its evidence, calibrated on drawn logs.

Faults that samples show by themselves are not found by a search; theirs is 1 less their p-value.

Three predictors: its likelihood ratio statistic, its BIC lead over the best alternative and over unnamed
patterns, and whether it reduces the error on held-out rows. The coefficients stand in a file beside this
module with their provenance; ``python -m tests.hidden calibrate`` writes it.
Source: Platt, Advances in Large Margin Classifiers (1999).
"""

import json
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path

import numpy as np

from ...fields import Fields, scalar_meanings
from ..result import Gain
from ..thresholds.checks import CONFIDENCE
from ..thresholds.search import SELECTION

CALIBRATION = Path(__file__).with_suffix(".json")
Predictors = tuple[float, float, float]
"""Strength of the evidence, lead over the alternatives, and the sign of the gain on held-out rows."""


@dataclass(frozen=True)
class Calibration:
    """Hold the log odds of a right finding: at no evidence, and per unit of each predictor."""

    offset: float
    per_strength: float
    per_lead: float
    per_gain: float

    @staticmethod
    @cache
    def read() -> "Calibration":
        """Read the calibrated coefficients."""
        meanings = {**scalar_meanings(Calibration), "provenance": "where the numbers come from"}
        fields = Fields(json.loads(CALIBRATION.read_text()), "the calibration", "", meanings)
        return Calibration(*(fields.number(name) for name in scalar_meanings(Calibration)))


def coefficients(found: Calibration) -> dict[str, object]:
    """Give the coefficients as they stand in the file."""
    return {name: round(value, 4) for name, value in asdict(found).items()}


def predictors(statistic: float, margin: float, measured: Gain | None) -> Predictors:
    """Give the predictors of a finding.

    Parameters
    ----------
    statistic
        Its likelihood ratio statistic.
    margin
        Its smallest BIC lead over an alternative or an unnamed pattern.
    measured
        Its gain on held-out rows; None where it was not measured.
    """
    clear = CONFIDENCE.clear_statistic
    strength = min((statistic - clear) / clear, CONFIDENCE.most_strength)
    lead = np.clip(margin / SELECTION.undecided, CONFIDENCE.least_lead, CONFIDENCE.most_lead)
    helps = 0.0 if measured is None else float(np.sign(measured.interval_95[0]))
    return float(strength), float(lead), helps


def probability(model: Calibration, evidence: Predictors) -> float:
    """Give the probability that a finding with this evidence is right."""
    strength, lead, helps = evidence
    score = model.offset + model.per_strength * strength + model.per_lead * lead + model.per_gain * helps
    return float(min(1.0 / (1.0 + np.exp(-score)), CONFIDENCE.certain))


def confidence(evidence: Predictors) -> float:
    """Give the calibrated probability that the named cause is the true one."""
    return probability(Calibration.read(), evidence)
