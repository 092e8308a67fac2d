"""Run estimators on the draws of a cell, a world with a noise, and keep every result as a line of JSON.

What a file holds already is not computed again, so that a long run can be taken up where it ended. A run that
fails is kept with its cause.
"""

import json
import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np

from benchmarks.estimators.bounds import information, oracle
from benchmarks.estimators.plant import Run, RunawayError
from benchmarks.estimators.worlds import NOISES, SECONDS, World, world
from veritorque.core.errors import VeritorqueError
from veritorque.core.estimate.methods.auto import AUTO
from veritorque.core.estimate.methods.kalman import KalmanFilter
from veritorque.core.estimate.methods.registry import ESTIMATORS
from veritorque.core.log.model import JointLog
from veritorque.core.study import IdentifyRequest, identify_in_full

CONTROLLER: Final = " (controller)"
"""What the name of an estimator ends in where the robot's own controller drives the simulated one."""
WITH_CONTROLLER: Final = ("iv", "didim", "clie", "cloe")
ORACLE: Final = "oracle"
LISTED: Final = (*ESTIMATORS, *(name + CONTROLLER for name in WITH_CONTROLLER))
"""All estimators of the bench, beside the oracle."""
COMMON: Final[Mapping[str, object]] = {
    "bootstrap": {"draws": 0},
    "validation": {"fraction": 0.0},
    "conflicts": "report",
}
"""All of the log is fitted, because the unseen motion is one of its own, and the robot is not corrected."""


OPEN: Final = -1.0
"""Stands for the deviation of a parameter that the motion leaves open, since JSON has no infinity."""


@dataclass(frozen=True)
class Cell:
    """Name a world and a noise, and the estimators with the number of their runs."""

    world: str
    noise: str
    runs: Mapping[str, int]
    seconds: float = SECONDS
    options: Mapping[str, object] = field(default_factory=dict)
    """Of every estimator, beside those in common."""


@dataclass(frozen=True)
class Result:
    """Hold one run of one estimator; `base` is None where it failed."""

    world: str
    noise: str
    estimator: str
    run: int
    base: list[float] | None = None
    deviation: list[float] | None = None
    feasible: bool = False
    converged: bool = True
    steps: int = 1
    cpu: float = 0.0
    failure: str = ""


class Ledger:
    """Keep results as lines of a file, or in memory where there is none."""

    def __init__(self, path: Path | None) -> None:
        self.path = path
        lines = path.read_text(encoding="utf-8").splitlines() if path is not None and path.exists() else []
        self.rows: list[dict[str, Any]] = [json.loads(line) for line in lines]

    def add(self, row: Mapping[str, Any]) -> None:
        """Append a line."""
        self.rows.append(dict(row))
        if self.path is not None:
            with self.path.open("a", encoding="utf-8") as file:
                file.write(json.dumps(row) + "\n")

    def results(self) -> list[Result]:
        """Give all runs."""
        return [Result(**{k: v for k, v in row.items() if k != "kind"}) for row in self._of("run")]

    def of_world(self, kind: str, name: str) -> dict[str, Any] | None:
        """Give what is known of a world: its ``scene`` or its ``bound``."""
        return next((row for row in self._of(kind) if row["world"] == name), None)

    def _of(self, kind: str) -> Iterator[dict[str, Any]]:
        return (row for row in self.rows if row["kind"] == kind)


def measure(cells: Iterable[Cell], ledger: Ledger, *, bounds: bool = True) -> None:
    """Run what the ledger lacks of some cells; `bounds` tells whether the Cramer-Rao bound is computed."""
    cells = list(cells)
    _compile_for({name.removesuffix(CONTROLLER) for cell in cells for name in cell.runs} - {ORACLE})
    done = {(one.world, one.noise, one.estimator, one.run) for one in ledger.results()}
    for cell in cells:
        own = world(cell.world, cell.seconds)
        _describe(own, ledger, bounds=bounds and own.plant.loop.is_soft)
        for run in range(max(cell.runs.values())):
            wanted = [
                name
                for name, runs in cell.runs.items()
                if run < runs and (cell.world, cell.noise, name, run) not in done
            ]
            for row in _results(own, cell, run, wanted) if wanted else ():
                ledger.add({"kind": "run", **asdict(row)})


def _compile_for(names: Iterable[str]) -> None:
    """Import what estimators compile, which is no estimator's time."""
    chosen = [ESTIMATORS[name] for name in names]
    if any(one.iterative or one.name == AUTO for one in chosen):
        import_module("veritorque.core.simulation.closed_loop.simulated")
    if any(isinstance(one, KalmanFilter) for one in chosen):
        import_module("veritorque.core.estimate.kalman.filtering")


def _describe(own: World, ledger: Ledger, *, bounds: bool) -> None:
    """Write down what the runs of a world are judged by."""
    if ledger.of_world("scene", own.name) is None:
        ledger.add(
            {
                "kind": "scene",
                "world": own.name,
                "names": list(own.base.names),
                "truth": own.truth.tolist(),
                "friction": own.friction.tolist(),
                "triangle": own.triangle.tolist(),
            }
        )
    if bounds and ledger.of_world("bound", own.name) is None:
        known = information(own)
        parts = {"position": known.position.tolist(), "torque": known.torque.tolist()}
        ledger.add({"kind": "bound", "world": own.name, **parts})


def _results(own: World, cell: Cell, run: int, wanted: list[str]) -> Iterator[Result]:
    """Simulate one draw and fit it by the estimators."""
    noise = NOISES[cell.noise]
    try:
        drawn = own.drawn(noise, run)
    except RunawayError as error:
        yield from (Result(cell.world, cell.noise, name, run, failure=str(error)) for name in wanted)
        return
    log = own.log(drawn, noise, run)
    for name in wanted:
        yield _fitted(own, cell, name, run, (drawn, log))


def _fitted(own: World, cell: Cell, name: str, run: int, draw: tuple[Run, JointLog]) -> Result:
    """Fit one log by one estimator."""
    drawn, log = draw
    blank = Result(cell.world, cell.noise, name, run)
    begun = time.process_time()
    try:
        if name == ORACLE:
            base = oracle(own, drawn, log, COMMON | dict(cell.options))
            return replace(blank, base=base.tolist(), cpu=time.process_time() - begun)
        options = options_for(name) | dict(cell.options)
        found = identify_in_full(IdentifyRequest(own.plant.arm.robot, (log,), options))
    except VeritorqueError as error:
        return replace(blank, failure=error.cause, cpu=time.process_time() - begun)
    spent = time.process_time() - begun
    deviation = found.precision.standard_deviation
    return replace(
        blank,
        base=found.estimate.base.tolist(),
        deviation=np.where(np.isfinite(deviation), deviation, OPEN).tolist(),
        feasible=bool(found.feasible),
        converged=found.convergence.converged,
        steps=max(len(found.convergence.steps), 1),
        cpu=spent,
    )


def options_for(name: str) -> dict[str, object]:
    """Give the options of an estimator of the bench."""
    if name.endswith(CONTROLLER):
        own = {"estimator": name.removesuffix(CONTROLLER), "simulation": {"from": "controller"}}
        return {**COMMON, **own}
    return {**COMMON, "estimator": name}
