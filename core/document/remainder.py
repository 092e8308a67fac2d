"""Write the unexplained residual of a diagnosis: dependences, explainable variance, noise floor."""

from operator import attrgetter

import numpy as np

from ..diagnosis.residual.atlas import Atlas
from ..diagnosis.result import Diagnosis, UnnamedPattern

SHOWN_DIGITS = 5
"""Digits of the bins of an atlas, which are for figures."""


def unexplained(diagnosis: Diagnosis, *, least: float) -> dict[str, object]:
    """Give the explainable variance of the residual per joint, and the noise floor.

    Parameters
    ----------
    least
        Lower end of the predictable share's interval above which a joint is listed under `joints`.
    """
    predictable, floor, unnamed = diagnosis.predictable, diagnosis.atlas.floor, diagnosis.unnamed_pattern
    predicted = {joint.joint for joint in predictable if joint.interval[0] > least}
    return {
        "joints": sorted(predicted | ({unnamed.joint} if unnamed else set())),
        "pattern": unnamed and _pattern(unnamed),
        "predictable_residual_fraction": list(map(attrgetter("share"), predictable)),
        "interval_95": list(map(attrgetter("interval"), predictable)),
        "at_rest_fraction": [None if np.isnan(share) else float(share) for share in diagnosis.at_rest],
        "rms_residual": list(map(attrgetter("rms"), predictable)),
        "places": list(map(attrgetter("places"), predictable)),
        "noise_floor": floor.rms,
        "noise_floor_source": floor.source,
        "noise_tilt": floor.tilt,
        "motion_period_s": floor.period,
    }


def _pattern(unnamed: UnnamedPattern) -> dict[str, object]:
    return {
        "joint": unnamed.joint,
        "statement": unnamed.statement,
        "likelihood_ratio": unnamed.statistic,
        "log10_p": unnamed.log10_p,
    }


def dependence_rows(atlas: Atlas) -> list[dict[str, object]]:
    """Tabulate the residual over every coordinate of every joint."""
    return [
        {
            "coordinate": dependence.coordinate,
            "joint": dependence.joint,
            "unit": dependence.unit,
            "centre": _round(dependence.centre),
            "mean": _round(dependence.mean),
            "standard_error": _round(dependence.standard_error),
            "count": dependence.count,
            "statistic": dependence.statistic,
            "degrees_of_freedom": dependence.degrees_of_freedom,
            "p_value": dependence.p_value,
        }
        for dependence in atlas.dependences
    ]


def spectrum_rows(atlas: Atlas) -> list[dict[str, object]]:
    """Tabulate power densities of residual and noise floor, (N m)^2/Hz, over frequency."""
    return [
        {
            "joint": spectrum.joint,
            "frequency_hz": _round(spectrum.frequency_hz),
            "density": _round(spectrum.density),
            "floor": _round(spectrum.floor),
        }
        for spectrum in atlas.spectra
    ]


def _round(values: np.ndarray) -> list[float]:
    return [float(f"{value:.{SHOWN_DIGITS}g}") for value in values]
