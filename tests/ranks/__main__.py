"""Compare ranks on drawn URDFs and print the differences: ``python -m tests.ranks --robots 250 --seed 1``."""

import argparse
import sys
from collections import Counter

from rich.console import Console
from rich.table import Table

from tests.ranks.compare import Comparison, compare
from tests.ranks.drawn import STYLES


def main() -> int:
    """Give 1 where a number of base parameters is not the rank."""
    parser = argparse.ArgumentParser(prog="python -m tests.ranks")
    parser.add_argument("--robots", type=int, default=250)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    first = chosen.seed * 100_000
    found = [compare(seed) for seed in range(first, first + chosen.robots)]
    _show(found)
    return any(not one.is_equal for one in found)


def _show(found: list[Comparison]) -> None:
    console = Console()
    table = Table(title="Base parameters against the rank of pinocchio's regressor", title_justify="left")
    headings = ("angles", "robots", "equal", "not clear", "least share kept", "least gap of singular values")
    for heading in headings:
        table.add_column(heading)
    for style in STYLES:
        own = [one for one in found if one.style == style]
        equal = Counter(one.is_equal for one in own)
        unclear = sum(not one.engine.is_clear for one in own)
        shares = min((one.least_share for one in own), default=1.0)
        gaps = min((one.engine.last / max(one.engine.next, 1e-300) for one in own), default=0.0)
        table.add_row(style, str(len(own)), str(equal[True]), str(unclear), f"{shares:.1e}", f"{gaps:.1e}")
    console.print(table)
    for one in found:
        if not one.is_equal:
            console.print(one)


if __name__ == "__main__":
    sys.exit(main())
