"""Compose the document of one joint's model: parameters with deviations, frequencies, errors."""

import numpy as np

from ..arrays import Vector
from ..errors import VeritorqueError
from ..joint_model.judge import is_late, turns_often
from ..joint_model.names import ESTIMATORS
from ..joint_model.response import measured_response, model_response
from ..joint_model.result import FoundModel, JointModel, Known, NotFound, relative_percent
from ..precision.inference import INTERVAL_95
from ..robot.joint_units import joint_unit
from ..robot.writing import to_description
from ..simulation.control.controller_check import ControllerCheck
from .identification import SCHEMA_VERSION
from .numbers import plain


def joint_document(found: JointModel, *, version: str, options: object) -> dict[str, object]:
    """Compose the document."""
    record, log = found.record, found.record.segment.log
    document = {
        "schema_version": SCHEMA_VERSION,
        "kind": "joint_model",
        "conflicts": [],
        "doubts": _doubts(found),
        "robot": to_description(found.robot),
        "logs": [
            {"name": log.name, "samples": log.samples, "duration_s": log.duration, "rate_hz": log.rate_hz}
        ],
        "provenance": {"version": version, "log_sha256": [log.sha256], "options": options},
        "joint": record.joint,
        "joint_type": "prismatic" if record.prismatic else "revolute",
        "order": found.options.order,
        "estimator": found.options.estimator,
        "estimator_title": ESTIMATORS[found.options.estimator],
        "flexibility": _flexibility(found),
        "models": [_model(model, found) for model in found.models],
        "response": _response(found),
        "controller": None if found.controller is None else _controller(found.controller, record.joint),
        "data": _data(found),
        "defects": [{"log": 1, **vars(defect)} for defect in log.defects],
    }
    return {key: plain(value) for key, value in document.items()}


def _data(found: JointModel) -> dict[str, object]:
    record = found.record
    begin, end = record.segment.begin_time, (len(record.position) - 1) * record.step
    fitted = record.fitted * record.step
    return {
        "begin_s": begin,
        "end_s": begin + end,
        "rate_hz": 1.0 / record.step,
        "samples": len(record.position),
        "held_out": [{"log": 1, "begin_s": begin + fitted, "end_s": begin + end}],
        "standing_percent": 100.0 * float(np.mean(record.standing)),
        "gravity": record.gravity,
        "travels": record.travels,
        "travels_allowed": [
            None if joint == record.joint else float(allowed)
            for joint, allowed in enumerate(record.allowed, start=1)
        ],
    }


def _flexibility(found: JointModel) -> dict[str, object]:
    """Say whether the log shows that the joint is flexible, and by which numbers."""
    flexible = found.flexible
    if flexible is None:
        return {"seen": None, "statement": "The flexible model was not asked for.", "evidence": {}}
    evidence = found.comparison or {}
    if isinstance(flexible, NotFound) or flexible.failure is not None:
        statement = _sentence(f"the flexible model is no answer: {_cause(flexible)}")
        return {"seen": False, "statement": statement, "evidence": evidence}
    stiffness, deviation = flexible.parameters.at("stiffness")
    unit = joint_unit(found.robot, found.record.joint, "N m/rad")
    natural = float(flexible.modes.values[0])
    return {
        "seen": True,
        "statement": f"The joint is flexible: {stiffness:.4g} {unit} (standard deviation {deviation:.2g}),"
        f" mode at {natural:.4g} Hz.",
        "evidence": evidence,
    }


def _cause(model: FoundModel | NotFound) -> str:
    return "" if model.failure is None else model.failure.cause


def _model(model: FoundModel | NotFound, found: JointModel) -> dict[str, object]:
    failure = model.failure
    row = {"order": model.order, "failure": None if failure is None else _failure(failure)}
    if isinstance(model, NotFound):
        return row | _NOTHING
    fitted, held_out, answered = model.fitted, model.held_out, failure is None
    return row | {
        "parameters": _rows(model.parameters, found) if answered else [],
        "frequencies": _rows(model.modes, found) if answered else [],
        "torque_error_percent": held_out.torque_percent,
        "torque_error_fitted_percent": held_out.torque_fitted_percent,
        "simulated_position_rms": held_out.position_rms,
        "simulated_position_percent": held_out.position_percent,
        "crossover_hz": model.crossover_hz,
        "torque_late_s": model.late[0],
        "torque_late_deviation_s": model.late[1],
        "converged": fitted.converged,
        "steps": [vars(step) for step in fitted.steps],
    }


_NOTHING: dict[str, object] = {
    "parameters": [],
    "frequencies": [],
    "torque_error_percent": None,
    "torque_error_fitted_percent": None,
    "simulated_position_rms": None,
    "simulated_position_percent": None,
    "crossover_hz": None,
    "torque_late_s": None,
    "torque_late_deviation_s": None,
    "converged": False,
    "steps": [],
}


def _failure(failure: VeritorqueError) -> dict[str, object]:
    return {"cause": failure.cause, "evidence": failure.evidence, "remedy": failure.remedy}


def _rows(known: Known, found: JointModel) -> list[dict[str, object]]:
    percent: Vector = relative_percent(known)
    around = INTERVAL_95 * np.array([-1.0, 1.0])
    return [
        {
            "name": quantity.name,
            "symbol": quantity.symbol,
            "unit": joint_unit(found.robot, found.record.joint, quantity.unit),
            "value": known.values[row],
            "standard_deviation": known.deviations[row],
            "relative_deviation_percent": percent[row],
            "interval_95": known.values[row] + around * known.deviations[row],
        }
        for row, quantity in enumerate(known.quantities)
    ]


def _response(found: JointModel) -> dict[str, object]:
    """Give the frequency response from torque to position: measured, and of every model that is an answer."""
    measured = measured_response(found.record)
    models = [one for one in found.models if isinstance(one, FoundModel) and one.failure is None]
    return {
        "unit": joint_unit(found.robot, found.record.joint, "rad/(N m)"),
        "frequency_hz": measured.frequency,
        "measured": np.abs(measured.response),
        "coherence": measured.coherence,
        "models": [
            {"order": model.order, "gain": np.abs(model_response(model.fitted.model, measured.frequency))}
            for model in models
        ],
    }


def _controller(check: ControllerCheck, joint: int) -> dict[str, object]:
    model, place = check.model, joint - 1
    return {
        "kind": model.kind,
        "velocity": model.velocity,
        "cutoff_hz": model.cutoff_hz,
        "delay_samples": model.delay_samples,
        "feed_forward": model.feed_forward,
        "kp": model.kp[place],
        "kd": model.kd[place],
        "ki": model.ki[place] if model.ki else None,
        "torque_gain": model.torque_gain[place] if model.torque_gain else None,
        "saturation": model.saturation[place] if model.saturation else None,
        "channel": check.channel,
        "command_residual_percent": 100.0 * check.tried[0].residual[place],
    }


def _doubts(found: JointModel) -> list[str]:
    doubts = []
    if found.record.segment.stamps is not None:
        doubts.append(
            "The stamps are uneven: the torque is interpolated, and not exactly held between samples."
        )
    asked = found.models[-1]
    answers = [model for model in found.models if isinstance(model, FoundModel) and model.failure is None]
    if any(turns_often(found.record, model.parameters) for model in answers):
        doubts.append(
            "The joint has dry friction and reverses often. Where it stands for an instant, friction is not "
            "modelled: inertia and frictions may be off by more than their deviations. Use longer strokes."
        )
    doubts += [_lateness(found, one) for one in answers[-1:] if is_late(found.record, one.late)]
    if asked.failure is not None:
        doubts.append(f"{_sentence(asked.failure.cause)} Remedy: {asked.failure.remedy}.")
    if asked.failure is not None and found.comparison is not None:
        doubts.append(
            f"A spring with a mode at {found.comparison['natural_hz']:.3g} Hz fits the log, but is not "
            "confirmed: if there is one, the rigid model's inertia holds a part of it, beyond its deviation."
        )
    return doubts


def _lateness(found: JointModel, answer: FoundModel) -> str:
    """Say how late the torque is by the model that is the answer, and what else looks alike.

    A spring in a rigid model looks like a delay; the flexible model's step along a long delay falls short.
    """
    way = "after" if answer.late[0] > 0.0 else "before"
    refused = found.flexible
    if answer.order == "flexible":
        told = f"by {_delay(answer)} or more {way} it acted. Move the torque by that time and ask again"
    elif isinstance(refused, FoundModel):
        told = (
            f"{way} it acted, by a time that is not known: {_delay(answer)} by the rigid model, which holds a"
            f" spring's part too, and {_delay(refused)} by the flexible model, which is refused. Move the "
            "torque by a part of it and ask again"
        )
    else:
        told = (
            f"by about {_delay(answer)} {way} it acted, if the joint is rigid: a spring in a rigid model "
            "looks alike. Move the torque by that time"
        )
    return (
        f"The torque stands in the log {told}, or log both at the same instants. It biases inertias, "
        "frictions and stiffness by more than their deviations. A filter of the torque looks alike."
    )


def _delay(model: FoundModel) -> str:
    seconds, deviation = model.late
    signed = abs(seconds) if model.failure is None else seconds
    return f"{1e3 * signed:.2g} ms (standard deviation {1e3 * deviation:.1g} ms)"


def _sentence(cause: str) -> str:
    return f"{cause[:1].upper()}{cause[1:]}."
