"""Write the conflicts of robot and logs, each with the correction to paste."""

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, cast

import numpy as np

from ..conflicts.check import Conflicts
from ..conflicts.reduced import mean_log
from ..errors import VeritorqueError
from ..log.columns.assignment import assigned, mapping_of
from ..log.model import JointLog
from ..robot.joint_units import prismatic_numbers
from ..robot.model import RobotModel
from ..robot.writing import to_description
from .numbers import plain

if TYPE_CHECKING:
    from ..conflicts.conflict import Hypothesis
    from ..conflicts.path import FoundConflict
    from ..conflicts.setup import Setup
    from ..conflicts.time_offset import TimeOffset

STAMPS_CONFIDENCE = 0.9
"""Probability that the stamps are wrong and not the unit of the velocity. Set by hand: units whose factor
lies so near one are rare."""


def conflict_rows(
    conflicts: Conflicts, robot: RobotModel, logs: tuple[JointLog, ...]
) -> list[dict[str, object]]:
    """Tabulate the conflicts of a robot as described and its logs as recorded.

    The correction of each holds all corrections together, so that any of them can be pasted.
    """
    correction = _correction(conflicts, robot, logs)
    fitted = [_row(found, correction, applied=conflicts.applied) for found in conflicts.found]
    alone = [row for place, log in enumerate(logs) for row in _rows_of_log(conflicts, place, log, correction)]
    return [{key: plain(value) for key, value in row.items()} for row in [*fitted, *alone]]


def _rows_of_log(
    conflicts: Conflicts, place: int, log: JointLog, correction: dict[str, object]
) -> Iterator[dict[str, object]]:
    """Tabulate what is wrong with one log, from 0: its stamps, its clock, its channels."""
    factor = conflicts.stamp_factors[place]
    if factor is not None:
        yield _stamps_row(factor, log, correction)
    offset = conflicts.offsets[place] if conflicts.offsets else None
    if offset is not None:
        yield _offset_row(offset, log, correction)
    for found in conflicts.of_logs[place] if conflicts.of_logs else ():
        yield _row_of_log(found, correction, log)


def conflict_sentence(row: dict[str, object]) -> str:
    """Say a conflict as a warning."""
    before, after = (cast("float | None", row[f"error_{when}_percent"]) for when in ("before", "after"))
    if before is None or after is None:
        return f"The log contradicts itself: {row['statement']}. Remedy: {row['remedy']}"
    end = (
        "Everything below is computed with this correction" if row["applied"] else f"Remedy: {row['remedy']}"
    )
    falls = f"; corrected, the mean error falls from {before:.3g} to {after:.3g} %" if after < before else ""
    return f"Robot and log disagree: {row['statement']}{falls}. {end}"


def because_of(rows: list[dict[str, object]], failure: VeritorqueError) -> VeritorqueError:
    """Name the conflicts that stand before a fit which failed; the failure itself where there are none."""
    if not rows:
        return failure
    return type(failure)(
        failure.cause,
        evidence=failure.evidence | {"conflicts": [row["statement"] for row in rows]},
        remedy=f"robot and log disagree: {'; '.join(str(row['remedy']) for row in rows)}",
    )


def with_conflicts(document: dict[str, object], rows: list[dict[str, object]]) -> dict[str, object]:
    """Put conflicts and warnings before all results, conflicts first among the warnings."""
    warnings = [*map(conflict_sentence, rows), *cast("list[str]", document["doubts"])]
    first = {key: document[key] for key in ("schema_version", "kind")}
    return (
        first
        | {"conflicts": rows, "doubts": warnings}
        | {key: value for key, value in document.items() if key not in {*first, "doubts"}}
    )


def _row(found: "FoundConflict", correction: dict[str, object], *, applied: bool) -> dict[str, object]:
    hypothesis, before, after = found.hypothesis, found.before, found.after
    used = hypothesis.setup.uses_torque
    return {
        "conflict": hypothesis.conflict,
        "joints": hypothesis.joints,
        "channel": hypothesis.channel,
        "confidence": found.confidence,
        "error_before_percent": 100.0 * np.exp(mean_log(before.errors[used])),
        "error_after_percent": 100.0 * np.exp(mean_log(after.errors[used])),
        "joint_errors_before_percent": 100.0 * before.errors,
        "joint_errors_after_percent": 100.0 * after.errors,
        "applied": applied,
        "statement": hypothesis.statement,
        "remedy": hypothesis.remedy,
        "correction": correction,
        "ambiguous_with": [_alternative(other) for other in found.equivalents],
    }


def _row_of_log(found: "FoundConflict", correction: dict[str, object], log: JointLog) -> dict[str, object]:
    """Tabulate a conflict of one log among several."""
    row = _row(found, correction, applied=False)
    return row | {
        "statement": f"in {log.name} alone, {row['statement']}",
        "remedy": f"in {log.name}, {row['remedy']}",
    }


def _alternative(hypothesis: "Hypothesis") -> dict[str, object]:
    return {
        "conflict": hypothesis.conflict,
        "joints": hypothesis.joints,
        "channel": hypothesis.channel,
        "why": f"it predicts these logs as well to say that {hypothesis.statement}",
    }


def _correction(conflicts: Conflicts, robot: RobotModel, logs: tuple[JointLog, ...]) -> dict[str, object]:
    """Give the mapping with which the logs are to be read, and the fields of the description to replace."""
    setup = conflicts.setup
    read = tuple(_read(log, place, conflicts) for place, log in enumerate(logs))
    written = partial(mapping_of, prismatic=prismatic_numbers(robot))
    mappings = [
        written(log) | _clock(factor, log) for log, factor in zip(read, conflicts.stamp_factors, strict=True)
    ]
    before = list(map(written, logs))
    described = {} if setup is None else _described(setup, robot)
    return {"mapping": mappings[0] if mappings != before else {}, "robot": described} | (
        {"mappings": mappings} if len(logs) > 1 and mappings != before else {}
    )


def _read(log: JointLog, place: int, conflicts: Conflicts) -> JointLog:
    """Read a log as it is corrected, with all others or alone."""
    alone = conflicts.of_logs[place] if conflicts.of_logs else ()
    setup = alone[-1].hypothesis.setup if alone else conflicts.setup
    return log if setup is None else assigned(log, setup.assignment)


def _described(setup: "Setup", robot: RobotModel) -> dict[str, object]:
    """Give the fields of the description to replace."""
    fields: dict[str, object] = {}
    if setup.robot.links is not robot.links:
        written = to_description(setup.robot)
        fields |= {field: written[field] for field in ("convention", "joints")}
    if not np.array_equal(setup.robot.gravity, robot.gravity):
        fields["gravity"] = setup.robot.gravity
    return fields


def _clock(factor: float | None, log: JointLog) -> dict[str, object]:
    """Give the part of a mapping that replaces stamps which are too close or too far apart."""
    return {} if factor is None else {"time": None, "rate_hz": log.rate_hz * factor}


def _offset_row(offset: "TimeOffset", log: JointLog, correction: dict[str, object]) -> dict[str, object]:
    before, after, late = offset.before, offset.after, offset.seconds > 0.0
    size = f"{abs(offset.seconds):.3g} s"
    return {
        "conflict": "time_offset",
        "joints": [],
        "channel": "torque",
        "confidence": STAMPS_CONFIDENCE,
        "error_before_percent": 100.0 * np.exp(before.score),
        "error_after_percent": 100.0 * np.exp(after.score),
        "joint_errors_before_percent": 100.0 * before.errors,
        "joint_errors_after_percent": 100.0 * after.errors,
        "applied": False,
        "statement": (
            f"the torques of {log.name} come about {size} {'after' if late else 'before'} the positions that "
            "they belong to, as where two recorders have two clocks"
        ),
        "remedy": (
            f"let the stamps of the torques begin {size} {'earlier' if late else 'later'} where both are put "
            "together, or log positions and torques by one clock"
        ),
        "correction": correction,
        "ambiguous_with": [],
    }


def _stamps_row(factor: float, log: JointLog, correction: dict[str, object]) -> dict[str, object]:
    return {
        "conflict": "time_base",
        "joints": [],
        "channel": None,
        "confidence": STAMPS_CONFIDENCE,
        "error_before_percent": None,
        "error_after_percent": None,
        "applied": False,
        "statement": (
            f"the measured velocity of {log.name} is {factor:.4g} times what positions and stamps give, on "
            f"every joint that moves, as if its stamps were {_slower(factor)}"
        ),
        "remedy": (
            f"correct the clock, as with a rate of {log.rate_hz * factor:.6g} Hz, or the unit of the velocity"
        ),
        "correction": correction,
        "ambiguous_with": [
            {"conflict": "unit", "joints": [], "channel": None, "why": "the velocity may be in another unit"}
        ],
    }


def _slower(factor: float) -> str:
    return f"{factor:.4g} times too far apart" if factor > 1.0 else f"{1.0 / factor:.4g} times too close"
