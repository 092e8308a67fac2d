"""Find a log's controller: recompute its command from reference and position, structure by structure.

A controller computes its command exactly, and in a stiff loop a wrong delay or velocity rule is far from it:
the residuals of least squares separate the structures.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from typing import Final

import numpy as np
from scipy.optimize import minimize_scalar

from ...arrays import EquationRows, JointMask, JointSeries
from ...errors import OptionError
from ...log.defects.saturation import Limit
from ...log.model import JointLog, LogRows
from .controller import KINDS, LONGEST_DELAY, RULES, ControllerModel, Kind, late, seen_velocity, speed_wanted
from .controller_fit import fitted_gains, left_by
from .declared import DeclaredController

ACCEPTED: Final = 0.02
"""Largest RMS of the recomputed less the logged command, as a share of the logged one. On the EMPS, a servo
axis with a known controller, the right structure leaves 0.24 %; with its gains a wrong velocity rule leaves
3.3 or 6.5 %, and a sample of delay 223 %."""
WORTH: Final = 0.1
"""Share of the residual that an integral has to explain: one more gain always explains some. Set by hand."""
MOST_ROWS: Final = 30_000
"""Rows that are looked at: 30 s at 1 kHz determine two or three gains. Set by hand."""
_CUTOFFS: Final = np.geomspace(2e-3, 0.4, 16)
"""Cut-offs from which the search begins, as shares of the rate."""


@dataclass(frozen=True)
class Tried:
    """Hold a structure with the gains that fit it best."""

    model: ControllerModel
    residual: tuple[float, ...]
    """RMS of recomputed less logged command per joint, as a share of the logged one."""
    at_best_gains: tuple[float, ...] | None
    """The same with the gains of the best structure, where it has gains of the same meaning."""

    @property
    def worst(self) -> float:
        """Give the residual of the joint that fits worst."""
        return max(self.residual)


@dataclass(frozen=True)
class ControllerCheck:
    """Hold what was tried, best first."""

    channel: str
    """Channel that the command was compared with."""
    tried: tuple[Tried, ...]
    declared: DeclaredController
    """What of it was declared, and not fitted."""

    @property
    def model(self) -> ControllerModel:
        """Give the best structure."""
        return self.tried[0].model

    @property
    def accepted(self) -> bool:
        """Tell whether it recomputes the log's command."""
        return self.tried[0].worst < ACCEPTED


@dataclass(frozen=True, eq=False)
class _Record:
    """Hold the rows that commands are recomputed of."""

    rows: LogRows
    step: float
    command: JointSeries
    channel: str
    kept: JointMask
    """Rows that are compared: neither saturated nor without neighbours."""
    declared: DeclaredController
    torque_gain: tuple[float, ...]
    saturation: tuple[float, ...]

    def size(self, joint: int) -> float:
        """Give the norm of the command that is compared."""
        return float(np.linalg.norm(self.command[self.kept[:, joint], joint]))


def check_controller(log: JointLog, declared: DeclaredController | None = None) -> ControllerCheck:
    """Fit every structure to the longest stretch of a log, or those that agree with what is declared.

    Raises
    ------
    OptionError
        If the log has no reference or no command, or no structure's gains can be determined.
    """
    declared = declared or DeclaredController()
    record = _record(log, declared)
    idle = [joint + 1 for joint in range(log.joints) if record.size(joint) == 0.0]
    tried = [] if idle else [one for kind in KINDS for one in _structures(record, kind)]
    if not tried:
        raise OptionError(
            "the gains of the controller cannot be determined from the log",
            evidence={"channel": record.channel, "joints_without_command": idle},
            remedy="give a log in which every joint moves beside its reference, or declare all gains",
        )
    tried.sort(key=lambda one: one.worst * (1.0 + WORTH * bool(one.model.ki)))
    best = tried[0].model
    return ControllerCheck(
        record.channel,
        tuple(replace(one, at_best_gains=_with_gains(record, one.model, best)) for one in tried),
        declared,
    )


def _record(log: JointLog, declared: DeclaredController) -> _Record:
    """Read the longest stretch, and say what is the command in it."""
    declared.check_joints(log.joints, log.rate_hz)
    start, stop = max(log.segments, key=lambda segment: segment[1] - segment[0])
    rows = log.source.rows(start, min(stop, start + MOST_ROWS))
    channel = "torque_ref" if rows.command is None else "command"
    command, _ = _logged(rows, channel), [_logged(rows, name, declared=True) for name in declared.channels]
    if np.array_equal(_logged(rows, "position_ref"), rows.position):
        raise OptionError(
            "the gains of the controller cannot be determined from the log",
            evidence={"largest_error": 0.0},
            remedy="log the reference that the controller was given, and not the measured position",
        )
    kept = np.zeros(command.shape, dtype=bool)
    kept[2 * LONGEST_DELAY : -2 * LONGEST_DELAY] = True
    limits = np.array([_limit(rows, column) for column in command.T])
    limits = np.minimum(limits, declared.saturation or np.inf)
    kept &= np.abs(command) < limits
    gain = _torque_gain(rows) if channel == "command" else ()
    declared.check_log(np.abs(command).max(axis=0), np.array(gain), ACCEPTED)
    gain = declared.torque_gain or gain
    saturation = tuple(map(float, limits)) if np.isfinite(limits).all() else ()
    return _Record(rows, 1.0 / log.rate_hz, command, channel, kept, declared, gain, saturation)


def _torque_gain(rows: LogRows) -> tuple[float, ...]:
    """Give the torque per unit of the command; nothing where no torque was logged."""
    if rows.torque is None:
        return ()
    command = _logged(rows, "command")
    scale = np.sum(command**2, axis=0)
    gain = tuple(map(float, np.sum(rows.torque * command, axis=0) / np.where(scale > 0.0, scale, 1.0)))
    if min(gain) < 0.0:
        raise OptionError(
            "the torque falls where the command rises, so that it is not made of it",
            evidence={"torque_per_command": [round(value, 6) for value in gain]},
            remedy="map the command of the logged torque, with the same sign",
        )
    return gain


def _logged(rows: LogRows, channel: str, *, declared: bool = False) -> JointSeries:
    """Give a channel without which nothing can be recomputed, or nothing that was declared."""
    series: JointSeries | None = getattr(rows, channel)
    if series is None:
        raise OptionError(
            "the log does not show what its controller did",
            evidence={"missing": channel, "channels": list(rows.channels())},
            remedy="log the reference of the position, and the command or the torque that was asked for"
            if channel in ("position_ref", "command", "torque_ref") and not declared
            else f"log {channel}, or leave what takes it out of the option controller",
        )
    return series


def _limit(rows: LogRows, command: np.ndarray) -> float:
    """Give the largest command where it is a limit, else infinity."""
    found = [Limit(), Limit()]
    for limit, values in zip(found, (command, -command), strict=True):
        limit.update(values, np.ones(len(values), dtype=bool), rows.time)
    return min((limit.top for limit in found if limit.holds()), default=np.inf)


def _structures(record: _Record, kind: Kind) -> Iterator[Tried]:
    """Fit every velocity rule, delay and feed-forward of one kind, without and with an integral."""
    for blank in filter(record.declared.allows, _blanks(record, kind)):
        searched = blank.velocity == "filtered" and record.declared.cutoff_hz is None
        rule = _with_cutoff(record, blank) if searched else blank
        found = (_fitted(record, rule, integral=integral) for integral in record.declared.integrals)
        yield from (one for one in found if one is not None)


def _blanks(record: _Record, kind: Kind) -> Iterator[ControllerModel]:
    """Give all structures of one kind that the log's channels allow, with gains of zero."""
    none = (0.0,) * record.command.shape[1]
    fed = record.channel == "command" and record.rows.torque_ref is not None
    rules = RULES if record.rows.velocity is not None else tuple(rule for rule in RULES if rule != "measured")
    delays = range(-LONGEST_DELAY, LONGEST_DELAY + 1)
    for rule, delay, forward in product(rules, delays, (False, True)[: 1 + fed]):
        blank = ControllerModel(
            kind=kind,
            kp=none,
            kd=none,
            torque_gain=record.torque_gain,
            velocity=rule,
            cutoff_hz=record.declared.cutoff_hz or 1.0 if rule == "filtered" else None,
            delay_samples=delay,
            saturation=record.saturation,
            feed_forward=forward,
        )
        yield blank


def _with_cutoff(record: _Record, blank: ControllerModel) -> ControllerModel:
    """Search the cut-off of a low pass, without an integral unless one is declared."""

    def at(logarithm: float) -> ControllerModel:
        return replace(blank, cutoff_hz=float(np.exp(logarithm)))

    def worst(logarithm: float) -> float:
        found = _fitted(record, at(logarithm), integral=record.declared.integrals[0])
        return 1.0 if found is None else found.worst  # as much as without gains

    grid = np.log(_CUTOFFS / record.step)
    best = int(np.argmin([worst(one) for one in grid]))
    bounds = grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]
    return at(float(minimize_scalar(worst, bounds=bounds, method="bounded").x))


def _terms(record: _Record, model: ControllerModel) -> tuple[JointSeries, JointSeries, JointSeries]:
    """Give the command less what is fed forward, and the errors of position and speed that it answers."""
    rows, delay = record.rows, model.delay_samples
    wanted = late(_logged(rows, "position_ref"), delay)
    speed = None if rows.velocity_ref is None else late(rows.velocity_ref, delay)
    if model.velocity == "measured":
        seen = _logged(rows, "velocity")
    else:
        seen = seen_velocity(model.velocity, rows.position, record.step, model.cutoff_hz)
    target = record.command
    if model.feed_forward:
        target = target - late(_logged(rows, "torque_ref"), delay) / model.per_joint("torque_gain")
    return target, wanted - rows.position, speed_wanted(model, record.step, wanted, speed) - seen


def _fitted(record: _Record, blank: ControllerModel, *, integral: bool) -> Tried | None:
    """Fit the gains of one structure; None where they cannot be determined, or are none of a controller."""
    fits, left = [], []
    for joint, table in enumerate(_tables(record, blank, integral=integral)):
        triangle = np.asarray(np.linalg.qr(table, mode="r"))
        found = fitted_gains(blank.kind, triangle[:, :-1], triangle[:, -1], record.declared.known(joint))
        if found is None or min(found) < 0.0:
            return None
        fits.append(found)
        left.append(left_by(blank.kind, found, triangle) / record.size(joint))
    kp, kd, ki = zip(*fits, strict=True)
    return Tried(replace(blank, kp=kp, kd=kd, ki=ki if integral else ()), tuple(left), None)


def _tables(record: _Record, model: ControllerModel, *, integral: bool) -> Iterator[EquationRows]:
    """Give per joint the rows that are compared: errors of position and speed, integrals of both, command."""
    target, error, slip = _terms(record, model)
    for joint, kept in enumerate(record.kept.T):
        columns = [error[:, joint], slip[:, joint]]
        if integral:
            columns += [record.step * np.cumsum(column) for column in columns]
        table = np.column_stack([*columns, target[:, joint]])[kept]
        # an integral may have begun anywhere
        yield table - table.mean(axis=0) if integral else table


def _residual(record: _Record, model: ControllerModel) -> tuple[float, ...]:
    """Give the RMS of recomputed less logged command per joint, as a share of the logged one."""
    gains = zip(model.kp, model.kd, model.per_joint("ki"), strict=True)
    tables = _tables(record, model, integral=bool(model.ki))
    return tuple(
        left_by(model.kind, (kp, kd, float(ki)), table) / record.size(joint)
        for joint, ((kp, kd, ki), table) in enumerate(zip(gains, tables, strict=True))
    )


def _with_gains(
    record: _Record, structure: ControllerModel, best: ControllerModel
) -> tuple[float, ...] | None:
    """Give what another structure leaves with the best one's gains, where they mean the same."""
    if structure.kind != best.kind or bool(structure.ki) != bool(best.ki):
        return None
    return _residual(record, replace(structure, kp=best.kp, kd=best.kd, ki=best.ki))
