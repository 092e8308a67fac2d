"""Condense the runs of every cell and estimator to the columns of the bench.

No run is dropped. One that failed counts with the error of the start, parameters up to 15 % off the truth,
and is counted. Errors are RMS over the runs, so that the scatter counts; the error of the mean of all
estimates is the bias, beside it. Parameters are compared by their errors over those of the oracle and of the
Cramer-Rao bound, the median over all of them: relative errors would be those of parameters near zero.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Final

import numpy as np

from benchmarks.estimators.bounds import Information
from benchmarks.estimators.cells import ORACLE, Ledger, Result
from benchmarks.estimators.worlds import NOISES, START_SEED, START_SHARE
from benchmarks.figures import Figure
from veritorque.core.precision.inference import INTERVAL_95

COLUMNS: Final = (
    "estimator",
    "runs",
    "torque error, %",
    "bias, %",
    "friction, %",
    "inertia, %",
    "of oracle",
    "of bound",
    "coverage, %",
    "feasible, %",
    "CPU, s",
    "steps",
    "failed",
)


@dataclass(frozen=True)
class Row:
    """Hold the figures of one estimator in one cell; None where there is none.

    Attributes
    ----------
    error, bias, friction, inertia
        Torque error on the unseen motion, % of its RMS: of all parameters, of the mean of the estimates, and
        of the parameters of friction and of the others apart.
    of_oracle, of_bound
        Median over parameters of the RMS error over the oracle's, and over the Cramer-Rao bound.
    coverage, feasible
        Share of parameters within the 95 % intervals, and of consistent robots, %.
    cpu, steps
        Means per run: s, and equations written.
    failed, unconverged
        Runs without estimate, and with one that the iteration did not reach.
    """

    world: str
    noise: str
    estimator: str
    runs: int
    error: float
    bias: float
    friction: float
    inertia: float
    of_oracle: float | None
    of_bound: float | None
    coverage: float | None
    feasible: float | None
    cpu: float
    steps: float
    failed: int
    unconverged: int

    def cells(self) -> list[str]:
        """Write the row as text, in the order of `COLUMNS`."""
        failed = f"{self.failed}" + (f" (+{self.unconverged} not converged)" if self.unconverged else "")
        shown = [self.of_oracle, self.of_bound, self.coverage]
        ratios = [_short(one) for one in shown]
        return [
            f"`{self.estimator}`",
            str(self.runs),
            *(_short(one) for one in (self.error, self.bias, self.friction, self.inertia)),
            *ratios,
            "" if self.feasible is None else f"{self.feasible:.0f}",
            f"{self.cpu:.2f}",
            f"{self.steps:.1f}",
            failed,
        ]


def summarised(ledger: Ledger) -> list[Row]:
    """Give one row per cell and estimator, in the order of their first runs."""
    results = ledger.results()
    order = {key: place for place, key in enumerate(dict.fromkeys(map(_key, results)))}
    results.sort(key=lambda one: (order[_key(one)], one.run))
    groups = {key: list(group) for key, group in groupby(results, _key)}
    return [_row(key, group, groups.get((*key[:2], ORACLE), []), ledger) for key, group in groups.items()]


def figures(rows: Iterable[Row]) -> list[Figure]:
    """Give the rows as figures of the benchmarks' table."""
    return [
        Figure(
            f"{row.world}, {row.noise}: {row.estimator}, %",
            f"{row.error:.3f}",
            "",
            ", ".join(f"{name} {text}" for name, text in zip(COLUMNS[1:], row.cells()[1:], strict=True)),
            ratio=True,
        )
        for row in rows
    ]


def markdown(rows: Sequence[Row]) -> str:
    """Write one table per cell."""
    parts = []
    for (world, noise), group in groupby(rows, lambda row: (row.world, row.noise)):
        lines = [f"### {world}, {noise}", "", "| " + " | ".join(COLUMNS) + " |"]
        lines += ["|" + "---|" * len(COLUMNS)]
        lines += ["| " + " | ".join(row.cells()) + " |" for row in group]
        parts.append("\n".join(lines))
    return "\n\n".join(parts) + "\n"


def _key(one: Result) -> tuple[str, str, str]:
    return one.world, one.noise, one.estimator


def _row(key: tuple[str, str, str], group: list[Result], ideal: list[Result], ledger: Ledger) -> Row:
    scene, bound = (ledger.of_world(kind, key[0]) for kind in ("scene", "bound"))
    if scene is None:
        raise ValueError(f"the file does not say what the truth of {key[0]} is")
    truth, triangle = np.array(scene["truth"]), np.array(scene["triangle"])
    friction = np.array(scene["friction"])
    missed = _missed(group, truth)
    size = np.linalg.norm(triangle @ truth)

    def percent(errors: np.ndarray) -> float:
        return float(100.0 * np.sqrt(np.mean(np.sum((errors @ triangle.T) ** 2, axis=-1))) / size)

    apart = np.sqrt(np.mean(missed**2, axis=0))
    # runs that the oracle has, too: the noises of both are the same
    both = _missed([one for one in ideal if one.run < len(group)], truth) if ideal else None
    deviations = None
    if bound is not None:
        known = Information(np.array(bound["position"]), np.array(bound["torque"]))
        deviations = known.deviations(NOISES[key[1]])
    judged = [one for one in group if one.deviation is not None]
    return Row(
        *key,
        runs=len(group),
        error=percent(missed),
        bias=percent(missed.mean(axis=0)),
        friction=percent(missed * friction),
        inertia=percent(missed * ~friction),
        of_oracle=None if both is None else float(np.median(apart / np.sqrt(np.mean(both**2, axis=0)))),
        of_bound=None if deviations is None else float(np.median(apart / deviations)),
        coverage=_coverage(judged, truth) if judged else None,
        feasible=None if key[2] == ORACLE else 100.0 * float(np.mean([one.feasible for one in group])),
        cpu=float(np.mean([one.cpu for one in group])),
        steps=float(np.mean([one.steps for one in group if one.base is not None] or [0])),
        failed=sum(one.base is None for one in group),
        unconverged=sum(one.base is not None and not one.converged for one in group),
    )


def _missed(group: Iterable[Result], truth: np.ndarray) -> np.ndarray:
    """Give the errors of the base parameters, runs x parameters."""
    return np.array([(_start(truth, one.run) if one.base is None else one.base) - truth for one in group])


def _start(truth: np.ndarray, run: int) -> np.ndarray:
    """Give the parameters that a failed run counts with: each up to 15 % off, by a seed of its own."""
    rng = np.random.default_rng([START_SEED, run])
    return truth * (1.0 + START_SHARE * rng.uniform(-1.0, 1.0, len(truth)))


def _coverage(judged: list[Result], truth: np.ndarray) -> float:
    base, deviation = (np.array([getattr(one, part) for one in judged]) for part in ("base", "deviation"))
    held = np.abs(base - truth) <= INTERVAL_95 * deviation
    return 100.0 * float(np.mean(held[deviation > 0.0]))


def _short(value: float | None) -> str:
    """Write a figure with as many digits as mean something."""
    if value is None:
        return ""
    return f"{value:.3f}" if value < 1.0 else f"{value:.2f}" if value < 10.0 else f"{value:.0f}"
