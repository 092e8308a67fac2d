"""Run parts of the estimators' bench: ``python -m benchmarks.estimators --worlds 'tx40-L1-*' --runs 5``.

Results are appended to a file, and what it holds already is not run again. Threads inside the linear algebra
are switched off before numpy is loaded.
"""

import argparse
import os
from fnmatch import fnmatch
from pathlib import Path

os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"))

from benchmarks.estimators.bench import FEW, RUNS, USUAL, runs_of, usual_names
from benchmarks.estimators.cells import LISTED, ORACLE, Cell, Ledger, measure
from benchmarks.estimators.summary import markdown, summarised
from benchmarks.estimators.worlds import NOISES, SECONDS, WORLDS


def main() -> None:
    """Read the command line, run what is missing, and print a table per cell."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.estimators", description=(__doc__ or "").partition("\n")[0]
    )
    usual = [world for world, _ in USUAL]
    parser.add_argument(
        "--worlds", nargs="+", default=usual, metavar="pattern", help=f"of {', '.join(WORLDS)}"
    )
    parser.add_argument("--noises", nargs="+", choices=list(NOISES), help="all usual ones by default")
    parser.add_argument("--estimators", nargs="+", choices=[ORACLE, *LISTED], help="all by default")
    parser.add_argument("--runs", type=int, default=RUNS, help=f"per cell, {RUNS} by default")
    parser.add_argument("--few", type=int, default=FEW, help=f"at most, of slow estimators, {FEW} by default")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="length of the logs")
    parser.add_argument("--file", type=Path, default=Path("estimators.jsonl"), help="keeps the results")
    parser.add_argument("--no-bound", action="store_true", help="leave the Cramer-Rao bound out")
    parser.add_argument("--show", action="store_true", help="print what the file holds, and run nothing")
    asked = parser.parse_args()
    if not any(fnmatch(name, pattern) for pattern in asked.worlds for name in WORLDS):
        parser.error(f"no such world; there are {', '.join(WORLDS)}")
    ledger = Ledger(asked.file)
    if not asked.show:
        measure(_cells(asked), ledger, bounds=not asked.no_bound)
    print(markdown(summarised(ledger)))


def _cells(asked: argparse.Namespace) -> list[Cell]:
    noises = dict(USUAL)
    cells = []
    for world in [name for name in WORLDS if any(fnmatch(name, pattern) for pattern in asked.worlds)]:
        names = usual_names(world)
        if asked.estimators:
            names = tuple(name for name in names if name in asked.estimators)
        cells += [
            Cell(world, noise, runs_of(names, asked.runs, asked.few), asked.seconds)
            for noise in asked.noises or noises.get(world, tuple(NOISES))
        ]
    return cells


if __name__ == "__main__":
    main()
