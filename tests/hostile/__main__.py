"""Send all hostile files to a service and print how each was treated: ``python -m tests.hostile``."""

import sys
import tempfile
from pathlib import Path

from rich.console import Console
from rich.table import Table

from tests.app.conftest import service
from tests.hostile.corpus import SPECIMENS, Treatment, treat, warm_up
from tests.hostile.specimen import Place


def main() -> int:
    """Give 1 where a promise was broken."""
    with tempfile.TemporaryDirectory() as folder:
        place = Place(Path(folder) / "outside")
        place.lay_out()
        with service(Path(folder) / "data") as client:
            warm_up(client)
            seen = [treat(client, specimen, place) for specimen in SPECIMENS]
    show(seen)
    return any(one.broken for one in seen)


def show(seen: list[Treatment]) -> None:
    table = Table(title="Hostile files", title_justify="left")
    for heading in ("file", "bytes", "status", "s", "MB", "broken", "cause"):
        table.add_column(heading)
    for one in seen:
        figures = (f"{one.bytes}", f"{one.status}", f"{one.seconds:.2f}", f"{one.peak_mb:.0f}")
        table.add_row(one.label, *figures, ", ".join(one.broken), one.cause)
    console = Console(width=200)
    console.print(table)
    console.print(
        f"{len(seen)} files, {sum(400 <= one.status < 500 for one in seen)} answered by 4xx; "
        f"slowest {max(one.seconds for one in seen):.2f} s, "
        f"most memory {max(one.peak_mb for one in seen):.0f} MB, "
        f"other files opened {sum(one.openings for one in seen)} times, "
        f"secrets told {sum(one.leaked for one in seen)}"
    )


if __name__ == "__main__":
    sys.exit(main())
