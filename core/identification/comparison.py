"""Fit the same equations by several estimators, and measure what each costs and how its robot moves.

An estimator that fails is a row of the table like any other: it says why.
"""

import time
from collections.abc import Mapping
from dataclasses import dataclass

from ..errors import ExcitationError, LogError, OptionError, SolverError, VeritorqueError
from ..estimate.methods.kalman import KalmanFilter
from ..estimate.methods.method import Estimator
from ..estimate.methods.registry import ESTIMATORS
from ..estimate.problem import Problem
from ..simulation.mechanism import mechanism_of
from ..simulation.multistep import MultiStep, predict_motion
from .comparison_options import options_for
from .identify import fit, judge, no_progress
from .options import parse_options
from .result import Identification


@dataclass(frozen=True, eq=False)
class Compared:
    """Hold what one estimator gave, or why it gave nothing."""

    estimator: str
    found: Identification | None
    failure: VeritorqueError | None
    motion: MultiStep | None
    """Errors of simulated motion on held-out blocks; None where it could not be simulated."""
    motion_note: str
    """Why not; empty where it could."""
    cpu_seconds: float
    """Processor time of fit and judgement, without the reading and conditioning of the logs."""


def fit_by(name: str, options: Mapping[str, object], begun: Identification) -> Compared:
    """Fit by one estimator what an identification has conditioned and observed."""
    _compile_for(ESTIMATORS[name])
    start = time.process_time()
    problem = Problem(begun.base, begun.motions, begun.held_out)
    try:
        own = parse_options(options_for(options, name))
        found = judge(begun.logs, fit(problem, own, no_progress, begun.observation), no_progress)
    except (ExcitationError, LogError, OptionError, SolverError) as error:
        return Compared(name, None, error, None, "", time.process_time() - start)
    spent = time.process_time() - start
    return Compared(name, found, None, *_motion(found), spent)


def _compile_for(method: Estimator) -> None:
    """Import what an estimator compiles, so that its time is that of a fit."""
    if isinstance(method, KalmanFilter):
        from ..estimate.kalman import filtering  # noqa: F401  (imported for what it compiles)
    elif method.iterative:
        from ..simulation.closed_loop import simulated  # noqa: F401  (imported for what it compiles)


def _motion(found: Identification) -> tuple[MultiStep | None, str]:
    """Simulate held-out windows; say why where the robot cannot be simulated."""
    if not found.held_out:
        return None, "no block is held out"
    try:
        mechanism = mechanism_of(found.base.model, found.estimate.standard)
        return predict_motion(mechanism, found.motions, chosen=found.held_out), ""
    except (LogError, OptionError, SolverError) as error:
        return None, error.cause
