"""Identify one joint: rigid first, then flexible from it, each with its own balance of noises.

The balance of the noises of torque and position is one frequency. The one with the smallest innovations has
the greatest likelihood, since the filter A / C is monic. Source: Ljung 1999, System Identification, ch. 7.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from ..errors import SolverError, VeritorqueError
from ..identification.identify import Progress
from ..log.model import JointLog
from ..robot.model import RobotModel
from .judge import comparison, crossover_hz, held_out, impossible, known, not_seen, unsettled
from .options import JointOptions, check_joint
from .orders import RIGID, TIME_UNIT
from .record import JointRecord, read_joint
from .refined_iv import Fitted, fit, residual, torque_delay
from .result import FoundModel, JointModel, NotFound
from .signals import ClosedLoop, closed_loop, loads_of, measured_signals, signals_of_link
from .start import flexible_start, rigid_start
from .task import Signals, Task

LOWEST_HZ: Final = 0.16
"""Lowest crossover: 1 rad/s. It takes the place of the integral's pole at zero, which does not decay."""
HIGHEST_SHARE: Final = 0.06
"""Highest crossover as a share of the rate: above it positions would be
differentiated from sample to sample."""
CROSSOVERS: Final = 12
"""Crossovers that are compared: neighbours differ by some 70 %, and deviations change little between them."""
BENDS: Final = 2
"""Times that the link's position is computed anew: each takes the error of gravity down by g / k."""
FIRST_HZ: Final = 2.0
"""Crossover to begin with. A rigid model of a flexible joint takes its own error for noise of the torque, and
would have the flexible one begin far too high."""
ROUNDS: Final = 3
"""Most often that the crossover is chosen anew and the model fitted by it."""


def identify_joint(robot: RobotModel, log: JointLog, options: JointOptions, progress: Progress) -> JointModel:
    """Identify the rigid model of a joint, and the flexible one where it is asked for.

    Raises
    ------
    VeritorqueError
        If the log does not show the joint alone, or no model of it is found.
    """
    check_joint(options.joint, len(robot.joints))
    progress("read", 0.02)
    record = read_joint(log, robot, options.joint)
    loop = closed_loop(record, robot) if options.estimator == "clsrivc" else None
    progress("rigid", 0.2)
    fitter = _Fitter(record, loop)
    rigid = fitter.rigid()
    check = None if loop is None else loop.check
    if options.order == RIGID.name:
        return _answered(JointModel(robot, record, options, rigid, None, None, check))
    progress("flexible", 0.4)
    flexible = fitter.flexible(rigid)
    if flexible.failure is not None:
        return _answered(JointModel(robot, record, options, rigid, flexible, None, check))
    evidence = comparison(flexible, rigid, record)
    flexible = replace(flexible, failure=not_seen(evidence))
    return _answered(JointModel(robot, record, options, rigid, flexible, evidence, check))


def _answered(found: JointModel) -> JointModel:
    """Give the models, unless none of them is an answer."""
    last = found.models[-1].failure
    if last is not None and all(model.failure is not None for model in found.models):
        raise last
    return found


def _driven_by(signals: Signals, task: Task) -> Task:
    """Give a task with other signals, which are the instruments as well: those of the open loop."""
    return replace(task, signals=signals, instruments=lambda _: signals)


class _Fitter:
    """Fit models to one record."""

    def __init__(self, record: JointRecord, loop: ClosedLoop | None) -> None:
        self.record, self.loop = record, loop
        self.measured = measured_signals(record)
        self.task = Task(
            position=record.position - record.position[0],
            origin=float(record.position[0]),
            signals=self.measured,
            step=record.step / TIME_UNIT,
            fitted=record.fitted,
            instruments=lambda _: self.measured,
            crossover=2.0 * np.pi * FIRST_HZ * TIME_UNIT,
        )

    def rigid(self) -> FoundModel:
        """Fit the rigid model."""
        return self._judged(self._balanced(fit(rigid_start(self.task), self.task)))

    def flexible(self, rigid: FoundModel) -> FoundModel | NotFound:
        """Fit the flexible model, from the rigid one."""
        first = self._flexible(rigid, self.task.crossover)
        if first.failure is None:
            return first
        again = self._flexible(rigid, rigid.fitted.task.crossover)
        return again if again.failure is None or isinstance(first, NotFound) else first

    def _flexible(self, rigid: FoundModel, crossover: float) -> FoundModel | NotFound:
        """Fit the flexible model, beginning with a balance of noises."""
        task = replace(self.task, crossover=crossover)
        try:
            return self._judged(self._balanced(flexible_start(rigid.fitted.model, task)))
        except SolverError as failure:
            return NotFound("flexible", failure)

    def _balanced(self, fitted: Fitted) -> Fitted:
        """Fit with the crossover of the smallest innovations."""
        fitted = self._behind_spring(fitted)
        for _ in range(ROUNDS):
            task = replace(fitted.task, crossover=self._crossover(fitted))
            if task.crossover == fitted.task.crossover:
                break
            fitted = self._behind_spring(fit(fitted.model, task))
        return fitted

    def _behind_spring(self, fitted: Fitted) -> Fitted:
        """Fit anew with gravity at the link of a flexible joint."""
        if not self.record.gravity or fitted.model.order is RIGID:
            return fitted
        for _ in range(BENDS):
            if min(fitted.model.order.physical(fitted.model.coefficients)[:3]) <= 0.0:
                return fitted
            signals = signals_of_link(self.record, fitted.model, fitted.task.signals)
            fitted = fit(fitted.model, _driven_by(signals, fitted.task))
        return fitted

    def _crossover(self, fitted: Fitted) -> float:
        """Give the crossover at which a model leaves the smallest innovations."""
        highest = HIGHEST_SHARE / self.record.step
        choices = 2.0 * np.pi * TIME_UNIT * np.geomspace(LOWEST_HZ, highest, CROSSOVERS)
        tasks = [replace(fitted.task, crossover=float(choice)) for choice in choices]
        found = [residual(fitted.model, task).innovation(task.fitted) for task in tasks]
        return tasks[int(np.argmin(found))].crossover

    def _judged(self, fitted: Fitted) -> FoundModel:
        """Judge a model, after instruments of the closed loop where these are asked for."""
        parameters, modes = known(fitted, loads_of(self.record))
        failure: VeritorqueError | None = impossible(fitted, parameters)
        loop, simulated = self.loop, None
        if loop is not None and failure is None:
            try:
                task = replace(fitted.task, instruments=lambda model: loop.play(model)[1])
                fitted = fit(fitted.model, task)
                simulated = loop.play(fitted.model)[0]
            except SolverError as error:
                failure = error
            parameters, modes = known(fitted, loads_of(self.record))
        failure = failure or impossible(fitted, parameters) or unsettled(fitted)
        return FoundModel(
            fitted,
            parameters,
            modes,
            held_out(fitted, simulated),
            crossover_hz(fitted),
            torque_delay(fitted),
            failure,
        )
