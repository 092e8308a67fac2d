"""Ask which thresholds matter: halve and double each, and find simulated logs that are answered otherwise.

An answer is the verdict and the causes with their joints. A threshold that changes no answer either way on
many logs decides nothing that these logs show: it may be too far off, or not needed. Logs that were answered
wrongly once are few, and close to more thresholds (`--regressions`).

Many thresholds are changed at once, see `tests.hidden.group_test`: a set that changes no answer is settled
in one pass. Two that cancel are not seen; ask for a few with `--only`, or for each by itself with `--count`.
"""

import argparse
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields, is_dataclass
from fnmatch import fnmatch
from functools import partial
from importlib import import_module
from multiprocessing import get_context
from multiprocessing.pool import Pool
from pkgutil import iter_modules
from typing import NamedTuple

from tests.hidden.group_test import group_test
from tests.hidden.plan import Order, drawn, orders, quick
from tests.plant.cases import ImpossibleError
from veritorque.core.dynamics.model import standard_model
from veritorque.core.identification.options import parse_diagnose_options
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan

PACKAGE = "veritorque.core.diagnosis"
FACTORS = {0.5: "halved", 2.0: "doubled"}
NEAR_ONE = {
    "CONFIDENCE.certain",
    "ENTRY.unchanged",
    "MASKING.within",
    "PREDICTION.quantile",
    "ROWS.spike_quantile",
    "VERDICT.at_rest",
}
"""Probabilities and shares near 1: it is their distance from 1 that is halved and doubled."""
ODD = {"ROWS.spike_order"}
LOADED = ("clarabel", "numba", "scipy.stats", "veritorque.core.numerics.boosted_trees", "tests.hidden.plan")
"""What every process begins with: all but the diagnosis, whose defaults are read when it is loaded."""
Answer = tuple[str, ...]
"""The verdict, and every cause with its joints."""


class Task(NamedTuple):
    """Ask for the answers to some cases with thresholds changed, up to the first one that is not expected."""

    names: tuple[str, ...]
    factor: float
    listed: tuple[Order, ...]
    expected: tuple[Answer, ...] = ()


class Answers(NamedTuple):
    """Hold the answers of a task, and the processor's time that they took, s."""

    task: Task
    answers: list[Answer]
    seconds: float


class Ablation:
    """Change thresholds on listed cases, in a new process each time, and add up the time that it takes."""

    def __init__(self, pool: Pool, listed: tuple[Order, ...]) -> None:
        self.pool, self.listed, self.seconds = pool, listed, 0.0
        self.plain = self._ask(Task((), 1.0, listed)).answers

    def first(self, factor: float, names: tuple[str, ...], cases: range) -> int | None:
        """Give the first of these cases that is answered otherwise, if any."""
        chosen = slice(cases.start, cases.stop)
        given = self._ask(Task(names, factor, self.listed[chosen], tuple(self.plain[chosen]))).answers
        last = cases.start + len(given) - 1
        return last if given and given[-1] != self.plain[last] else None

    def all(self, name: str, factor: float) -> Answers:
        """Give the answers to all cases with one threshold changed."""
        return self._ask(Task((name,), factor, self.listed))

    def _ask(self, task: Task) -> Answers:
        found = self.pool.apply(answers, (task,))
        self.seconds += found.seconds
        return found


def main(arguments: Sequence[str]) -> int:
    """Run the cases as they are and with thresholds changed, and print which answers differ."""
    asked = _arguments(arguments)
    names = [name for name in thresholds() if any(fnmatch(name, only) for only in asked.only)]
    listed = tuple(_possible(_orders(asked)))
    context = get_context("forkserver")
    context.set_forkserver_preload(list(LOADED))
    begun = time.monotonic()
    with context.Pool(2, maxtasksperchild=1) as pool, ThreadPoolExecutor(2) as both:
        ablation = Ablation(pool, listed)
        _say(
            f"{len(names)} thresholds, {len(listed)} cases, {ablation.seconds:.0f} s of a processor per pass"
        )
        (_count if asked.count else _search)(ablation, names, both)
    _say(f"{ablation.seconds:.0f} s of processors, {time.monotonic() - begun:.0f} s")
    return 0


def _search(ablation: Ablation, names: Sequence[str], both: ThreadPoolExecutor) -> None:
    """Print the first case that each threshold has answered otherwise, and those that change none."""

    def search(some: Sequence[str]) -> list[str]:
        left = list(some)
        for factor, word in FACTORS.items():  # one that is known to matter is not asked about again
            for found in group_test(left, len(ablation.listed), partial(ablation.first, factor)):
                if found.case is None:
                    _say(f"({len(found.names)} {word} together change none)")
                    continue
                for name in found.names:
                    left.remove(name)
                    _say(f"{name:34} {word:8} {label(ablation.listed[found.case])}")
        return left

    none = [name for part in both.map(search, (names[::2], names[1::2])) for name in part]
    _say(f"{len(names) - len(none)} change an answer, {len(none)} change none:")
    _say("\n".join(f"    {name}" for name in names if name in none))


def _count(ablation: Ablation, names: Sequence[str], both: ThreadPoolExecutor) -> None:
    """Print how many answers each threshold changes by itself: two passes over all cases for each."""
    _say(f"{'answers that change when':34} {'halved':>8} {'doubled':>8}")
    for name in names:
        halved, doubled = both.map(ablation.all, [name] * 2, FACTORS)
        _say(line(ablation.plain, halved, doubled))


def label(order: Order) -> str:
    """Name a case as a table shows it."""
    return " ".join(str(part) for part in (order.robot, order.kind, order.cause, order.seed) if part)


def line(plain: list[Answer], halved: Answers, doubled: Answers) -> str:
    """Say how many answers a threshold changes; an exclamation mark says that some failed."""
    counts = [
        sum(old != new for old, new in zip(plain, changed.answers, strict=True))
        for changed in (halved, doubled)
    ]
    failed = any(answer[0].startswith("failed") for one in (halved, doubled) for answer in one.answers)
    remark = "" if any(counts) else "   changes none"
    return f"{halved.task.names[0]:34} {counts[0]:8} {counts[1]:8}{'  !' if failed else remark}"


def thresholds() -> dict[str, tuple[object, str]]:
    """Find every threshold: the group that holds it, and its field, by the name that the code uses."""
    package = import_module(f"{PACKAGE}.thresholds")
    modules = [import_module(f"{package.__name__}.{one.name}") for one in iter_modules(package.__path__)]
    return {
        f"{name}.{field.name}": (group, field.name)
        for module in modules
        for name, group in vars(module).items()
        if is_dataclass(group) and not isinstance(group, type)
        for field in fields(group)
    }


def changed_value(name: str, value: float, factor: float) -> float:
    """Halve or double a threshold; a whole number stays one, and at least 1.

    Examples
    --------
    >>> changed_value("SEARCH.causes", 5, 0.5), changed_value("MASKING.within", 0.9, 0.5)
    (2, 0.95)
    """
    if name in NEAR_ONE:
        return 1.0 - factor * (1.0 - value)
    if isinstance(value, int):
        whole = max(int(value * factor), 1)
        return whole | 1 if name in ODD else whole
    return value * factor


def answers(task: Task) -> Answers:
    """Answer the cases of a task in this process, which must not have loaded the diagnosis before."""
    loaded = [name for name in sys.modules if name.startswith(PACKAGE) and "thresholds" not in name]
    if set(loaded) - {PACKAGE}:
        raise RuntimeError(f"loaded before the threshold was changed: {loaded}")
    groups = thresholds()
    for name in task.names:
        group, field = groups[name]
        value = changed_value(name, getattr(group, field), task.factor)
        object.__setattr__(group, field, value)  # groups are frozen for everybody else
    begun, given = time.process_time(), []
    for place, order in enumerate(task.listed):
        given.append(_answer(order))
        if task.expected and given[-1] != task.expected[place]:
            break
    return Answers(task, given, time.process_time() - begun)


def _answer(order: Order) -> Answer:
    from veritorque.core.diagnosis.diagnose import diagnose
    from veritorque.core.diagnosis.problem import DiagnosisProblem

    case = drawn(order)
    base = base_model(standard_model(case.believed, None))
    plan, validation = ColumnPlan(base.model, base.kept), parse_diagnose_options({}).validation
    try:
        found = diagnose(DiagnosisProblem(plan, (case.log,), validation.chosen(1), validation.blocks))
    except Exception as error:  # noqa: BLE001 - a failure is an answer, too
        return (f"failed: {error}",)
    return (found.verdict, *sorted(f"{one.cause} {list(one.joints)}" for one in found.findings))


def _orders(asked: argparse.Namespace) -> list[Order]:
    if asked.regressions:
        from tests.hidden.regressions import QUICK  # with the diagnosis, which no process of a task may load

        return [regression.order for regression in QUICK]
    return orders(asked.seed, asked.cases) if asked.cases else quick(asked.seed)


def _possible(listed: list[Order]) -> Iterator[Order]:
    """Draw the cases, which are kept from then on, and leave out those that cannot be drawn."""
    for order in listed:
        try:
            drawn(order)
        except ImpossibleError:
            continue
        yield order


def _arguments(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m tests.hidden ablate", description=__doc__.partition("\n")[0]
    )
    parser.add_argument("--seed", type=int, default=1, help="decides every case")
    parser.add_argument("--cases", type=int, help="draw as many of all arms, not short logs of small ones")
    parser.add_argument(
        "--regressions", action="store_true", help="take logs that were answered wrongly once instead"
    )
    parser.add_argument("--count", action="store_true", help="count all changed answers, which takes hours")
    parser.add_argument("--only", nargs="+", default=["*"], metavar="GROUP.FIELD", help="names or patterns")
    return parser.parse_args(arguments)


def _say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()
