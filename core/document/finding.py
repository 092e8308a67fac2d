"""Write a finding as rows of the result document: every number with its unit and how well it is known."""

import numpy as np

from ..diagnosis.causes.protocol import Quantity, Site
from ..diagnosis.causes.registry import BY_ID
from ..diagnosis.result import Alternative, Finding, Gain, NotIdentifiable

ROUNDING = 1e-9
"""Share of its deviation below which a value is zero but for rounding."""


def finding_row(finding: Finding) -> dict[str, object]:
    """Write one finding."""
    return {
        "cause": finding.cause,
        "title": finding.title,
        "joints": finding.joints,
        "statement": finding.statement,
        "confidence": finding.confidence,
        "p_value": finding.p_value,
        "cure": finding.cure,
        "parameters": [_quantity(quantity) for quantity in finding.quantities],
        "explained_residual_fraction": finding.explained_fraction,
        "evidence": finding.evidence,
        "ambiguous_with": [_alternative(other) for other in finding.ambiguous_with],
        "refuted": [_alternative(other) for other in finding.refuted if _concerns(other, finding)],
        "gain": None if finding.gain is None else _gain(finding.gain),
        "curve": None if finding.curve is None else dict(vars(finding.curve)),
    }


def not_identifiable_row(cause: NotIdentifiable) -> dict[str, object]:
    """Write a cause that the motion could not have shown."""
    return {
        "cause": cause.cause,
        "title": title_of(cause.cause),
        "joints": cause.joints,
        "why": cause.why,
        "separating_experiment": cause.separating_experiment,
    }


def title_of(cause: str) -> str:
    """Say in words what a cause is.

    Examples
    --------
    >>> title_of("torque_ripple")
    'Torque ripple'
    """
    return BY_ID[cause].title if cause in BY_ID else cause


def percent_of(deviation: float, value: float) -> float | None:
    """Give a standard deviation in percent of a value; None where the value is zero but for rounding.

    Examples
    --------
    >>> percent_of(0.5, -10.0), percent_of(0.5, 0.0), percent_of(0.5, 1e-17)
    (5.0, None, None)
    """
    return 100.0 * deviation / abs(value) if abs(value) > ROUNDING * deviation else None


def _concerns(alternative: Alternative, finding: Finding) -> bool:
    """Decide whether an alternative acts on a joint of the finding, or on the whole robot."""
    return not alternative.joints or bool(set(alternative.joints) & set(finding.joints))


def _quantity(quantity: Quantity) -> dict[str, object]:
    return {
        "name": quantity.name,
        "joint": quantity.joint,
        "unit": quantity.unit,
        "value": quantity.value,
        "standard_deviation": quantity.standard_deviation,
        "relative_deviation_percent": percent_of(quantity.standard_deviation, quantity.value),
    }


def _alternative(alternative: Alternative) -> dict[str, object]:
    joints: Site = alternative.joints
    return {
        "cause": alternative.cause,
        "title": title_of(alternative.cause),
        "joints": joints,
        "statistic": alternative.statistic,
        "why": alternative.why,
        "separating_experiment": alternative.separating_experiment,
    }


def _gain(gain: Gain) -> dict[str, object]:
    """Give the errors per joint; nothing is known of one without rows to judge by."""
    known = gain.before > 0.0
    before, after, percent = (
        np.where(known, own, np.nan) for own in (gain.before, gain.after, gain.improvement_percent)
    )
    return {
        "rms_residual_before": before,
        "rms_residual_after": after,
        "held_out": True,
        "improvement_percent": percent,
        "improvement_total_percent": gain.total_percent,
        "interval_95": gain.interval_95,
    }
