"""Ask which thresholds matter: halve and double each, and count the drawn logs that are answered otherwise.

An answer is the verdict and the causes with their joints. A threshold that changes no answer either way on
many logs decides nothing that these logs show: it may be too far off, or not needed.
"""

import argparse
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import fields, is_dataclass
from fnmatch import fnmatch
from importlib import import_module
from multiprocessing import get_context
from pkgutil import iter_modules
from typing import NamedTuple

from tests.hidden.plan import Order, answered, drawn, orders
from tests.plant.cases import ImpossibleError

PACKAGE = "veritorque.core.diagnosis"
FACTORS = (0.5, 2.0)
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
Answer = tuple[str, ...]
"""The verdict, and every cause with its joints."""


class Task(NamedTuple):
    """Ask for the answers to some cases with one threshold changed; with none where it has no name."""

    name: str
    factor: float
    listed: tuple[Order, ...]


class Answers(NamedTuple):
    """Hold the answers of a task, and the processor's time that they took, s."""

    task: Task
    answers: list[Answer]
    seconds: float


def main(arguments: Sequence[str]) -> int:
    """Run the cases as they are and with every threshold changed, and print how many answers differ."""
    asked = _arguments(arguments)
    names = [name for name in thresholds() if any(fnmatch(name, only) for only in asked.only)]
    listed = tuple(_possible(orders(asked.seed, asked.cases)))
    tasks = [Task("", 1.0, listed), *(Task(name, factor, listed) for name in names for factor in FACTORS)]
    begun, seconds = time.monotonic(), 0.0
    _say(f"{len(names)} thresholds, {len(listed)} cases; answers that change when a threshold is")
    _say(f"{'':34} {'halved':>8} {'doubled':>8}")
    # A fresh process for every task: defaults are read when a module is loaded.
    with ProcessPoolExecutor(2, mp_context=get_context("spawn"), max_tasks_per_child=1) as pool:
        done = pool.map(answers, tasks)
        plain = next(done)
        seconds += plain.seconds
        for halved, doubled in zip(done, done, strict=True):
            seconds += halved.seconds + doubled.seconds
            _say(line(plain.answers, halved, doubled))
    _say(f"{seconds:.0f} s of processors ({plain.seconds:.0f} s per pass), {time.monotonic() - begun:.0f} s")
    return 0


def line(plain: list[Answer], halved: Answers, doubled: Answers) -> str:
    """Say how many answers a threshold changes; an exclamation mark says that some failed."""
    counts = [
        sum(old != new for old, new in zip(plain, changed.answers, strict=True))
        for changed in (halved, doubled)
    ]
    failed = any(answer[0].startswith("failed") for one in (halved, doubled) for answer in one.answers)
    remark = "" if any(counts) else "   changes none"
    return f"{halved.task.name:34} {counts[0]:8} {counts[1]:8}{'  !' if failed else remark}"


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
    if task.name:
        group, field = thresholds()[task.name]
        value = changed_value(task.name, getattr(group, field), task.factor)
        object.__setattr__(group, field, value)  # groups are frozen for everybody else
    begun = time.process_time()
    return Answers(task, [_answer(order) for order in task.listed], time.process_time() - begun)


def _answer(order: Order) -> Answer:
    try:
        found = answered(drawn(order))
    except Exception as error:  # noqa: BLE001 - a failure is an answer, too
        return (f"failed: {error}",)
    return (found["verdict"], *sorted(f"{one['cause']} {one['joints']}" for one in found["findings"]))


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
    parser.add_argument("--cases", type=int, default=20, help="how many are drawn")
    parser.add_argument("--only", nargs="+", default=["*"], metavar="GROUP.FIELD", help="names or patterns")
    return parser.parse_args(arguments)


def _say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()
