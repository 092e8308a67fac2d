"""Compose the result document of a diagnosis: identification, findings, and corrections.

Names are those that clients are written against; fields may be added, never renamed. What a figure needs is
in the document, so that a report can be drawn from it alone, at any time.
"""

from typing import cast

from ..diagnosis.thresholds.checks import VERDICT
from ..extension.gain import JointGain, motion_intervals
from ..extension.repair import repairs
from ..extension.result import Extension
from ..identification.reference_score import ReferenceScore
from ..identification.result import Identification
from ..simulation.multistep import Comparison
from .extended import answer_fields, extended_rows
from .finding import finding_row, not_identifiable_row
from .identification import held_out_spans, identification_document, score_rows
from .model.identified import BaseValue, IdentifiedRobot
from .model.model_file import model_document
from .motion import position_errors
from .numbers import plain
from .payload import payload_row
from .remainder import dependence_rows, spectrum_rows, unexplained
from .repairs import repaired_description


def diagnosis_document(found: Extension, *, version: str, options: object) -> dict[str, object]:
    """Compose the document; its model is the extended one where there is one."""
    document = identification_document(found.before, version=version, options=options)
    document |= {key: plain(value) for key, value in answer_fields(found).items()}
    doubted = {"doubts": [*cast("list[str]", document["doubts"]), *_doubts(found.compared)]}
    return document | doubted | {"kind": "diagnose", "diagnosis": plain(_diagnosis(found))}


def _diagnosis(found: Extension) -> dict[str, object]:
    diagnosis = found.diagnosis
    listed = repairs(diagnosis)
    return {
        "verdict": diagnosis.verdict,
        "findings": [
            finding_row(finding) | {"payload": payload_row(finding, diagnosis)}
            for finding in diagnosis.findings
        ],
        "not_identifiable": [not_identifiable_row(cause) for cause in diagnosis.not_identifiable],
        "unexplained": unexplained(diagnosis, least=VERDICT.unexplained_share),
        "reference": None if found.compared is None else _reference(found.compared, found.before),
        "gain": [_gain(gain) for gain in found.gains],
        "before": _side(found.before if found.compared is None else found.compared),
        "after": {"validation": [], "base_parameters": []}
        if found.after is None
        else _side(found.after) | _extension(found.before, found.after),
        "repairs": listed,
        "repaired_robot": repaired_description(diagnosis.dataset.robot, listed),
        "simulation": _simulation(found.motion, found.motion_note),
        "atlas": dependence_rows(diagnosis.atlas),
        "spectra": spectrum_rows(diagnosis.atlas),
        "search": [
            {
                "action": step.action,
                "cause": step.candidate.cause.id,
                "joints": step.candidate.site,
                "statistic": step.statistic,
            }
            for step in diagnosis.steps
        ],
        "band_hz": diagnosis.dataset.band_hz,
        "held_out": held_out_spans(found.before, diagnosis.dataset.held_out_blocks),
    }


def _gain(gain: JointGain) -> dict[str, object]:
    """Tabulate what a joint gained; nothing is known of one without rows to judge by."""
    known = gain.rms_before > 0.0
    return {
        "joint": gain.joint,
        "rms_residual_before": gain.rms_before if known else None,
        "rms_residual_after": gain.rms_after if known else None,
        "improvement_percent": gain.improvement_percent if known else None,
        "interval_95": gain.interval_95 if known else None,
        "held_out": True,
    }


def _reference(compared: ReferenceScore, found: Identification) -> dict[str, object]:
    """Say what the logs were compared with, and where it and what was identified anew disagree."""
    return {
        "name": compared.reference.name,
        "left_open": compared.reference.left_open,
        "worse_than_nothing": compared.worse_than_nothing,
        "base_parameters": [
            {"name": name, "reference": old, "identified": new}
            for name, old, new in zip(found.base.names, compared.base, found.estimate.base, strict=True)
        ],
    }


def _doubts(compared: ReferenceScore | None) -> list[str]:
    if compared is None or not compared.worse_than_nothing:
        return []
    joints = ", ".join(map(str, compared.worse_than_nothing))
    sentence = (
        f"The torque error of the reference exceeds the RMS torque of joint {joints}: it may be of "
        "another robot, or have other units or signs"
    )
    return [sentence]


def _side(found: Identification | ReferenceScore) -> dict[str, object]:
    return {
        "fit": score_rows(found.fit),
        "fit_total_percent": found.fit_total_percent,
        "validation": score_rows(found.validation),
        "validation_total_percent": found.validation_total_percent if found.validation else None,
    }


def _extension(before: Identification, after: Identification) -> dict[str, object]:
    solution = after.estimate.solution
    return {
        "base_parameters": extended_rows(before, after),
        "feasible": after.feasible,
        "solver": {
            "status": "optimal" if solution is None else solution.status,
            "objective": after.estimate.objective,
            "objective_ols": after.estimate.objective_unconstrained,
        },
        "model": model_document(_identified_robot(after)),
    }


def _identified_robot(found: Identification) -> IdentifiedRobot:
    """Give what was identified as files need it."""
    base = found.base
    rows = range(len(base.kept))
    return IdentifiedRobot(
        model=base.model,
        standard=found.estimate.standard,
        identifiable=tuple(base.identifiability(column) for column in range(len(base.model.parameters))),
        base=tuple(
            BaseValue(base.names[row], base.parameter(row).unit, float(value), base.in_words(row))
            for row, value in zip(rows, found.estimate.base, strict=True)
        ),
    )


def _simulation(motion: Comparison | None, note: str) -> dict[str, object]:
    if motion is None:
        return {"before": {}, "after": {}, "note": note}
    return {
        "held_out": True,
        "note": note,
        "before": position_errors(motion.before),
        "after": position_errors(motion.after),
        "improvement_percent": motion.gain_percent,
        "improvement_total_percent": motion.total_gain_percent,
        "interval_95": motion_intervals(motion),
    }
