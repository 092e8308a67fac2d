"""Diagnosis over all causes of logs from an engine that is not ours: its cost, and how that grows.

The search takes most of the time, and the more so the more there is to find; so logs that hide one effect or
three stand beside those that hide nothing, stage by stage. Robots differ in the band of their motion: costs
are compared per row that was looked at.
"""

import cProfile
import pstats
import statistics
import time
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from itertools import count, islice
from pathlib import Path

import numpy as np

from benchmarks.figures import Figure
from tests.plant.cache import kept
from tests.plant.cases import Case, ImpossibleError, draw, draw_clean
from veritorque.core.diagnosis.diagnose import diagnose
from veritorque.core.diagnosis.problem import DiagnosisProblem
from veritorque.core.dynamics.model import standard_model
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan
from veritorque.core.validation.holdout import HoldOut

ROBOTS = ("planar-2", "planar-3", "ur10e", "yumi-left")
SECONDS = (15.0, 30.0, 60.0, 120.0)
USUAL = SECONDS[1]
QUICK_SECONDS = (4.0, 8.0)
BLOCKS = 40
CLEAN_SEED = 11
DRAWN = 10
"""Logs of a kind whose stages are measured."""
PROFILED, SHOWN = 33, 20
"""Logs of a kind that a profile is of, and the functions that it names."""
TARGETS = {0: "<= 1.2", 1: "<= 2", 3: "<= 4"}
"""Median processor time by the number of hidden effects, s."""
FIRST_STAGE = "check samples"
"""What a diagnosis does before it reports a stage."""


def run(*, quick: bool) -> list[Figure]:
    """Diagnose logs of rising length and robots of rising size, in one run."""
    robots, seconds = (ROBOTS[:2], QUICK_SECONDS) if quick else (ROBOTS, SECONDS)
    usual = seconds[1]
    largest = robots[-1]
    _stages(_clean(robots[0], seconds[0]))  # the first one loads what all need
    costs = {length: _cost_of_clean(largest, length) for length in seconds}
    figures = [
        Figure(f"{largest}, {length:.0f} s, nothing hidden, processor s", f"{cost:.2f}", _target(length))
        for length, (cost, _) in costs.items()
    ]
    for effects in (0,) if quick else TARGETS:
        figures += _by_stage(effects, largest, usual, 1 if quick else DRAWN)
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


def profile(*, quick: bool) -> list[Figure]:
    """Diagnose drawn logs, and give the stages and the functions that cost most, s per log.

    The profiler itself costs time, in small functions the most.
    """
    robot, seconds, logs = (ROBOTS[0], QUICK_SECONDS[0], 1) if quick else (ROBOTS[-1], USUAL, PROFILED)
    figures: list[Figure] = []
    for effects in TARGETS:
        cases = list(islice(_drawn(effects, robot, seconds), logs))
        profiler = cProfile.Profile()
        spent = [profiler.runcall(_stages, case)[0] for case in cases]
        head = f"hidden effects: {effects}, drawn logs: {logs}"
        figures += [
            Figure(f"{head}: {stage}", f"{sum(one[stage] for one in spent) / logs:.2f}") for stage in spent[0]
        ]
        rows = pstats.Stats(profiler).get_stats_profile().func_profiles.items()
        for name, one in sorted(rows, key=lambda row: -row[1].tottime)[:SHOWN]:
            where = f"{Path(one.file_name).stem}:{one.line_number}"
            figures.append(
                Figure(f"  {where} {name}", f"{one.tottime / logs:.3f}", "", f"{one.ncalls} calls in all")
            )
    return figures


def _by_stage(effects: int, robot: str, seconds: float, logs: int) -> list[Figure]:
    """Diagnose drawn logs, and give the median, with those of all stages beside it, and the slowest."""
    spent = [_stages(case)[0] for case in islice(_drawn(effects, robot, seconds), logs)]
    totals = [sum(stages.values()) for stages in spent]
    stages = ", ".join(f"{name} {statistics.median(one[name] for one in spent):.2f}" for name in spent[0])
    what = f"{robot}, {seconds:.0f} s, hidden effects: {effects}, drawn logs: {logs}, processor s"
    return [
        Figure(f"{what}: median", f"{statistics.median(totals):.2f}", TARGETS[effects], stages),
        Figure(f"{what}: slowest", f"{max(totals):.2f}", "<= 10"),
    ]


def _drawn(effects: int, robot: str, seconds: float) -> Iterator[Case]:
    """Draw logs one after the other, but for those in which so many effects cannot be hidden."""
    for seed in count(1_000 * (1 + effects)):
        try:
            if effects:
                yield kept(draw, seed, effects=effects, robot=robot, duration=seconds)
            else:
                yield kept(draw_clean, seed, robot=robot, duration=seconds)
        except ImpossibleError:
            continue


def _stages(case: Case) -> tuple[dict[str, float], int]:
    """Give the processor time of a diagnosis by stages, s, and how many rows it looked at."""
    spent: dict[str, float] = defaultdict(float)
    stage, since = FIRST_STAGE, time.process_time()

    def begin(name: str, _done: float) -> None:
        nonlocal stage, since
        now = time.process_time()
        spent[stage] += now - since
        stage, since = name, now

    model = standard_model(case.believed)
    plan = ColumnPlan(model, base_model(model).kept)
    question = DiagnosisProblem(plan, (case.log,), HoldOut(0.25, BLOCKS).chosen(1), BLOCKS)
    found = diagnose(question, begin)
    begin("", 1.0)
    return spent, len(found.dataset.time)


def _target(length: float) -> str:
    return "<= 10" if length == USUAL else ""


@cache
def _clean(robot: str, seconds: float) -> Case:
    return draw_clean(CLEAN_SEED, robot=robot, duration=seconds)


@cache
def _cost_of_clean(robot: str, seconds: float) -> tuple[float, int]:
    """Give the processor time of a diagnosis, s, and how many rows it looked at."""
    spent, rows = _stages(_clean(robot, seconds))
    return sum(spent.values()), rows


def _per_row(robot: str, seconds: float) -> float:
    cost, rows = _cost_of_clean(robot, seconds)
    return cost / rows
