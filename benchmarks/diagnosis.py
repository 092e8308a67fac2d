"""Diagnosis over all causes of logs from an engine that is not ours: its cost, and how that grows.

The search takes most of the time, and the more so the more there is to find; so a log that hides three
effects stands beside one that hides nothing. Robots differ in the band of their motion: costs are compared
per row that was looked at.
"""

from functools import cache

import numpy as np

from benchmarks.figures import Figure, processor_seconds
from tests.plant.cases import Case, draw, draw_clean
from veritorque.core.diagnosis.diagnose import diagnose
from veritorque.core.diagnosis.problem import DiagnosisProblem
from veritorque.core.dynamics.model import standard_model
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan
from veritorque.core.validation.holdout import HoldOut

ROBOTS = ("planar-2", "planar-3", "ur10e", "yumi-left")
SECONDS = (15.0, 30.0, 60.0, 120.0)
USUAL = SECONDS[1]
QUICK_SECONDS = (6.0, 12.0)
BLOCKS = 40
CLEAN_SEED, HIDDEN_SEED = 11, 7


def run(*, quick: bool) -> list[Figure]:
    """Diagnose logs of rising length and robots of rising size, in one run."""
    robots, seconds = (ROBOTS[:2], QUICK_SECONDS) if quick else (ROBOTS, SECONDS)
    usual = seconds[1]
    largest = robots[-1]
    costs = {length: _cost_of_clean(largest, length) for length in seconds}
    figures = [
        Figure(f"{largest}, {length:.0f} s, nothing hidden, processor s", f"{cost:.2f}", _target(length))
        for length, (cost, _) in costs.items()
    ]
    if not quick:
        three, _ = _cost(draw(HIDDEN_SEED, effects=3, robot=largest))
        figures.append(
            Figure(f"{largest}, {USUAL:.0f} s, three effects hidden, processor s", f"{three:.2f}", "<= 10")
        )
    first, last = seconds[0], seconds[-1]
    each = costs[last][0] / costs[first][0] * first / last
    figures.append(
        Figure(
            f"cost per second of log, {last:.0f} s over {first:.0f} s", f"{each:.2f}", "<= 1.2", ratio=True
        )
    )
    sizes = [(len(_clean(name, usual).believed.joints), _per_row(name, usual)) for name in robots]
    joints, spent = np.log(np.array(sizes)).T
    apart = joints - joints.mean()
    slope = float(apart @ spent / (apart @ apart))
    counts = ", ".join(str(count) for count, _ in sizes)
    return [*figures, Figure(f"power of the number of joints ({counts})", f"{slope:.2f}", "<= 2", ratio=True)]


def _target(length: float) -> str:
    return "<= 10" if length == USUAL else ""


@cache
def _clean(robot: str, seconds: float) -> Case:
    return draw_clean(CLEAN_SEED, robot=robot, duration=seconds)


@cache
def _cost_of_clean(robot: str, seconds: float) -> tuple[float, int]:
    return _cost(_clean(robot, seconds))


def _per_row(robot: str, seconds: float) -> float:
    cost, rows = _cost_of_clean(robot, seconds)
    return cost / rows


def _cost(case: Case) -> tuple[float, int]:
    """Give the processor time of a diagnosis, s, and how many rows it looked at."""
    model = standard_model(case.believed)
    plan = ColumnPlan(model, base_model(model).kept)
    question = DiagnosisProblem(plan, (case.log,), HoldOut(0.25, BLOCKS).chosen(1), BLOCKS)
    rows: list[int] = []
    spent = processor_seconds(lambda: rows.append(len(diagnose(question).dataset.time)), repeats=1, least=0.0)
    return spent, rows[-1]
