"""Compose the result document of an identification, with the names that clients are written against.

Fields may be added, never renamed. Every estimated number stands beside its unit and its uncertainty.
"""

from collections.abc import Collection, Sequence

import numpy as np

from ..arrays import BlockKey
from ..identification.doubts import doubts
from ..identification.result import Identification
from ..log.model import JointLog
from ..numerics.block_bootstrap import interval_95
from ..precision.inference import INTERVAL_95, relative_deviation_percent
from ..reduction.base import BaseModel
from ..regressor.observe import Observation
from ..robot.writing import to_description
from ..signals.condition import Motion
from ..validation.quality import quality
from ..validation.scores import JointScore
from .bodies import body_rows
from .estimation import estimation_fields
from .model.reference import write_factor
from .model.terms import named_terms
from .numbers import plain

SCHEMA_VERSION = "1.0"


def identification_document(found: Identification, *, version: str, options: object) -> dict[str, object]:
    """Compose the document."""
    document = {
        "schema_version": SCHEMA_VERSION,
        "kind": "identify",
        "robot": to_description(found.base.model.robot),
        "logs": [_log(log, motion) for log, motion in zip(found.logs, found.motions, strict=True)],
        "provenance": {
            "version": version,
            "log_sha256": [log.sha256 for log in found.logs],
            "options": options,
        },
        **model_fields(found),
        "rank": found.base.rank,
        "held_out": held_out_spans(found, found.held_out),
        "coulomb_smoothing_widths": found.widths,
        "defects": [
            {"log": number, **vars(defect)}
            for number, log in enumerate(found.logs, start=1)
            for defect in log.defects
        ],
        "doubts": doubts(found),
        "model": {"name": "plain", "statement": "The plain model, as the robot's description states it"},
        "plain": None,
        "diagnosis": None,
    }
    return {key: plain(value) for key, value in document.items()}


def model_fields(found: Identification) -> dict[str, object]:
    """Give the fields that describe one model: its parameters, its consistency, its errors."""
    return {
        "counts": {
            "standard": len(found.base.model.parameters),
            "base": len(found.base.kept),
            "essential": len(found.essential.kept),
        },
        "base_parameters": base_parameter_rows(found),
        "terms": named_terms(found.base.model),
        "standard_parameters": _standard_parameters(found),
        "bodies": body_rows(found.base.model, found.estimate.standard),
        "feasibility": _feasibility(found),
        "solver": _solver(found),
        "estimation": estimation_fields(found),
        "fit": score_rows(found.fit),
        "fit_total_percent": found.fit_total_percent,
        "validation": score_rows(found.validation),
        "validation_total_percent": found.validation_total_percent if found.validation else None,
        "validation_reversals_percent": found.reversals_percent,
        "condition_number": found.excitation.condition_number,
        "condition_number_scaled": found.excitation.condition_number_scaled,
        "precision": _precision(found),
        "essential_path": _path(found),
    }


def score_rows(scores: Sequence[JointScore]) -> list[dict[str, object]]:
    """Tabulate the errors per joint, each with a word for it; without rows to judge by nothing is known."""
    return [
        {**vars(score), "quality": quality(score.nrmse_of_rms_percent)}
        if score.samples
        else dict.fromkeys((*vars(score), "quality")) | {"joint": score.joint, "samples": 0}
        for score in scores
    ]


def base_parameter_rows(found: Identification) -> list[dict[str, object]]:
    """Tabulate the base parameters in the order of Khalil's tables."""
    estimate = found.estimate
    deviation = found.precision.standard_deviation
    percent = relative_deviation_percent(estimate.base, deviation)
    essential = set(found.essential.kept.tolist())
    drawn = interval_95(found.draws) if len(found.draws) else None
    return [
        {
            **_name_row(found.base, row),
            "value": estimate.base[row],
            "value_ols": estimate.unconstrained[row],
            "standard_deviation": deviation[row],
            "relative_deviation_percent": percent[row],
            "interval_95": estimate.base[row] + INTERVAL_95 * np.array([-1.0, 1.0]) * deviation[row],
            "bootstrap_interval_95": None if drawn is None else drawn[row],
            "own_share": found.excitation.own_share[row],
            "essential": row in essential,
            **_grouping(found.base, row),
        }
        for row in range(len(found.base.kept))
    ]


def grouping_row(base: BaseModel, row: int) -> dict[str, object]:
    """Name a base parameter, and say in words and as data what is grouped in it."""
    return {**_name_row(base, row), **_grouping(base, row)}


def _name_row(base: BaseModel, row: int) -> dict[str, object]:
    parameter = base.parameter(row)
    return {"name": base.names[row], "unit": parameter.unit, "joint": parameter.joint}


def _grouping(base: BaseModel, row: int) -> dict[str, object]:
    return {"grouping": base.in_words(row), "relation": base.relation(row)}


def _standard_parameters(found: Identification) -> list[dict[str, object]]:
    return [
        {
            "name": parameter.name,
            "joint": parameter.joint,
            "unit": parameter.unit,
            "value": found.estimate.standard[column],
            "identifiable": found.base.identifiability(column),
        }
        for column, parameter in enumerate(found.base.model.parameters)
    ]


def _feasibility(found: Identification) -> dict[str, object]:
    return {
        "feasible": found.feasible,
        "margin": found.estimate_feasibility.margin,
        "ols_feasible": found.unconstrained_feasibility.feasible,
        "ols_margin": found.unconstrained_feasibility.margin,
        "ols_plausible": found.unconstrained_plausible,
        "sizes": [
            {
                "link": link,
                "centre": extent.ball.centre,
                "radius": extent.ball.radius,
                "source": extent.source,
            }
            for link, extent in enumerate(found.extents, start=1)
            if extent is not None
        ],
        "costly_sizes": [
            {"link": costly.bound.link, "cost_ratio": costly.ratio} for costly in found.estimate.costly
        ],
        "pseudo_inertia_min_eigenvalue": found.pseudo_inertia_eigenvalues,
        "active_constraints": found.active_constraints,
        "mass_matrix_min_eigenvalue": {
            "trajectory": found.trajectory.min_eigenvalue,
            "trajectory_configurations": found.trajectory.configurations,
            "workspace": found.workspace.min_eigenvalue,
            "configurations": found.workspace.configurations,
        },
        "prior": found.estimate.prior.source,
    }


def _solver(found: Identification) -> dict[str, object]:
    solution = found.estimate.solution
    return {
        "status": "optimal" if solution is None else solution.status,
        "iterations": 0 if solution is None else solution.iterations,
        "solver": "qr" if solution is None else solution.solver,
        "bounds_margin": None if solution is None else solution.margin,
        "objective": found.estimate.objective,
        "objective_ols": found.estimate.objective_unconstrained,
    }


def held_out_spans(found: Identification, keys: Collection[BlockKey]) -> list[dict[str, object]]:
    """List the spans of the logs that are held out of every fit."""
    return [
        {"log": block.log + 1, "begin_s": block.start, "end_s": block.end}
        for block in found.observation.blocks
        if (block.log, block.number) in keys
    ]


def _precision(found: Identification) -> dict[str, object]:
    system, filtered, factor = found.estimate.system, found.innovations, found.precision.memory_factor
    return {
        "equations": system.rows,
        "noise": system.noise if filtered is None else filtered.torque_noise,
        "memory_factor": factor if filtered is None else [1.0] * len(filtered.torque_noise),
        "standard_deviation_kind": "sandwich" if filtered is None else "blocks",
        "information_factor": write_factor(found.precision.root),
        "left_out_percent": 100.0 * (1.0 - _used_share(found.observation)),
        "reversal_weights": found.reversal_weights,
        "reversals_percent": 100.0 * _turning_share(found.observation),
        "bootstrap_draws": len(found.draws),
        "bootstrap_seed": found.seed,
    }


def _used_share(observation: Observation) -> float:
    rows = sum(factor.rows for factor in observation.joint_factors())
    return rows / max(observation.kept * len(observation.columns_of), 1)


def _turning_share(observation: Observation) -> float:
    """Give the share of the equations that lie beside a reversal."""
    turning = sum(factor.rows for factor in observation.turning_factors())
    return turning / max(sum(factor.rows for factor in observation.joint_factors()), 1)


def _path(found: Identification) -> list[dict[str, object]]:
    return [
        {"name": found.base.names[step.parameter], "ratio": step.ratio, "objective": step.cost}
        for step in found.essential.path
    ]


def _log(log: JointLog, motion: Motion) -> dict[str, object]:
    recipe = motion.recipe
    return {
        "name": log.name,
        "samples": log.samples,
        "duration_s": log.duration,
        "rate_hz": log.rate_hz,
        "ignored_columns": log.ignored_columns,
        "filter": {
            "median_order": recipe.median_order,
            "position_cutoff_hz": recipe.position_cutoff_hz,
            "cutoff_hz": recipe.cutoff_hz,
            "order": recipe.order,
            "decimation": recipe.decimation,
            "motion_band_hz": recipe.motion_band_hz,
            "reason": recipe.reason,
        },
    }
