"""Say which cells of the bench are run by default, and give their figures."""

from collections.abc import Mapping
from typing import Final

from benchmarks.estimators.cells import LISTED, ORACLE, Cell, Ledger, measure
from benchmarks.estimators.summary import figures, summarised
from benchmarks.estimators.worlds import NOISES
from benchmarks.figures import Figure

RUNS, FEW = 50, 5
"""Runs per cell, and of slow estimators."""
SLOW: Final = (
    *("clie", "cloe", "oe", "ekf", "srukf", "auto"),
    *("iv (controller)", "didim (controller)", "clie (controller)", "cloe (controller)"),
)
"""Estimators that take more than a second."""
USUAL: Final = (
    ("tx40-L1-coulomb-slow", tuple(NOISES)),
    ("tx40-L2-coulomb-slow", ("1e-3/.05", "1e-2/.05")),
    ("tx40-L3-coulomb-slow", ("1e-3/.05", "1e-2/.5")),
    ("tx40-L1-presliding-slow", ("1e-3/.05",)),
    ("tx40-L1-coulomb-fast", ("1e-3/.05", "1e-2/.05")),
    ("yumi-L1-coulomb-slow", ("1e-3/.05", "1e-2/.05")),
)
"""Worlds with their noises that are run unless others are named."""
QUICK_WORLD: Final = "planar-L1-coulomb-slow"


def runs_of(names: tuple[str, ...], runs: int, few: int) -> Mapping[str, int]:
    """Give the number of runs of estimators: fewer of the slow ones."""
    return {name: min(runs, few) if name in SLOW else runs for name in names}


def usual_names(world: str) -> tuple[str, ...]:
    """Name the estimators that a world's logs allow, the oracle first."""
    controlled = "-L2-" not in world
    return (ORACLE, *(name for name in LISTED if controlled or "controller" not in name))


def run(*, quick: bool) -> list[Figure]:
    """Measure all estimators in the usual worlds, or in one of two joints."""
    if quick:
        names = runs_of(usual_names(QUICK_WORLD), FEW, 2)
        cells = [Cell(QUICK_WORLD, noise, names) for noise in ("1e-3/.05", "1e-2/.5")]
    else:
        cells = [
            Cell(world, noise, runs_of(usual_names(world), RUNS, FEW))
            for world, noises in USUAL
            for noise in noises
        ]
    ledger = Ledger(None)
    measure(cells, ledger)
    return figures(summarised(ledger))
