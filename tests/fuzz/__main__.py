"""Read spoilt files and print how the readings ended: ``python -m tests.fuzz --runs 1000000 --seed 1``."""

import argparse
import sys
import tempfile
import time
from pathlib import Path

import pyarrow as pa
from rich.console import Console
from rich.table import Table

from tests.fuzz.campaign import MAPPING, Tally, case, run
from tests.fuzz.seeds import seeds
from veritorque.app.inspection.inspector import Inspector
from veritorque.app.inspection.log_reading import LogFile
from veritorque.app.problems import Problem

MEMORY_DISK = Path("/dev/shm")  # noqa: S108  (a folder with a random name in it)


def main() -> int:
    """Give 1 where a reading ended otherwise than by a result or an error of ours."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz")
    parser.add_argument("--runs", type=int, default=10_000, help="files in all formats together")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--form", choices=tuple(seeds()), action="append")
    chosen = parser.parse_args()
    forms = chosen.form or list(seeds())
    pa.set_memory_pool(pa.system_memory_pool())
    begin, share = time.monotonic(), -(-chosen.runs // len(forms))
    with tempfile.TemporaryDirectory(dir=MEMORY_DISK if MEMORY_DISK.is_dir() else None) as made:
        folder = Path(made)
        tallies = [run(form, runs=share, seed=chosen.seed, folder=folder) for form in forms]
        contained = {tally.form: _contained(tally, chosen.seed, folder) for tally in tallies}
    show(tallies, contained, seconds=time.monotonic() - begin)
    return any(tally.untyped or tally.hung or contained[tally.form] < len(tally.deaths) for tally in tallies)


def _contained(tally: Tally, seed: int, folder: Path) -> int:
    """Count the cases whose reader died and which the service still answers by a problem."""
    inspector, answered = Inspector(), 0
    for number, _ in tally.deaths:
        path = folder / "upload"
        path.write_bytes(case(tally.form, seed, number))
        try:
            inspector.summarise(
                LogFile(path, "fuzz", MAPPING, "0" * 64), size=path.stat().st_size, media_type=None
            )
            answered += 1  # a reader that had read less before survives
        except Problem as problem:
            answered += 400 <= problem.status_code < 500
    return answered


def show(tallies: list[Tally], contained: dict[str, int], *, seconds: float) -> None:
    table = Table(title="Spoilt files", title_justify="left")
    for heading in (
        "format", "runs", "refused", "accepted", "out of memory", "not typed", "hung", "slow (> 1 s)",
        "reader died", "of these answered 4xx", "growth, KB per 1000",
    ):  # fmt: skip  # a table
        table.add_column(heading)
    for one in tallies:
        growth = 1000.0 * one.growth_kb / one.grown_in if one.grown_in else 0.0
        counts = (
            one.runs, one.endings["refused"], one.endings["accepted"], one.endings["out of memory"],
            len(one.untyped), len(one.hung), one.slow, len(one.deaths), contained[one.form],
        )  # fmt: skip  # a table
        table.add_row(one.form, *map(str, counts), f"{growth:.1f}")
    console = Console(width=170)
    console.print(table)
    console.print(f"{sum(one.runs for one in tallies)} files in {seconds:.0f} s")
    for one in tallies:
        for what, cases in (("not typed", one.untyped), ("hung", one.hung), ("died", one.deaths)):
            if cases:
                console.print(f"{one.form} {what}: cases {cases[:10]}")


if __name__ == "__main__":
    sys.exit(main())
