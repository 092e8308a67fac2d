"""Make the table of docs/accuracy.md again, row by row, as that page says that it was made.

The logs are public measurements kept beside the project; without them these tests skip and say so.
"""

import re
from pathlib import Path

import pytest

from tests.measured import identified, measured_log

ROOT = Path(__file__).parents[2]
PRINTED = 0.06
"""The table prints one decimal; a little more than half a unit of it, for rounding twice."""

Cut = tuple[str, int, int | None]
UR10E: list[Cut] = [("fourier_30s_12h", 635, 3510), ("fourier_20s_8h", 320, 2310)]
UR10E_40S: Cut = ("fourier_40s_12h", 500, 4460)
UR10E_50S: Cut = ("fourier_50s_12h", 355, 5090)
UR10E_MOVES: Cut = ("validation_ptp_10pts", 700, 4200)
TX40: list[Cut] = [("run1", 500, 26_050), ("run1", 26_050, 37_000)]
PANDA: list[Cut] = [("traj1", 0, 10_272), ("traj1", 10_272, 20_544)]
XMATE: list[Cut] = [("excit", 0, None)]
ROWS: list[tuple[str, list[Cut], dict[str, object]]] = [
    ("ur10e_open", [*UR10E, UR10E_40S], {}),
    ("ur10e_open", [*UR10E, UR10E_40S], {"filter": {"cutoff_hz": 15.0}}),
    ("ur10e_open", [*UR10E, UR10E_50S], {}),
    ("ur10e_open", [UR10E[0], UR10E_MOVES], {}),
    ("staubli_tx40", TX40, {}),
    ("staubli_tx40", TX40, {"filter": {"cutoff_hz": 50.0}}),
    ("staubli_tx40", TX40, {"filter": {"cutoff_hz": 50.0}, "smooth_coulomb": True}),
    ("staubli_tx40", TX40, {"smooth_coulomb": True}),
    ("franka_panda", PANDA, {}),
    ("franka_panda", PANDA, {"filter": {"cutoff_hz": 15.0}}),
    ("rokae_xmate3", XMATE, {}),
    ("rokae_xmate3", XMATE, {"filter": {"cutoff_hz": 10.0}}),
]
"""The rows of the table in their order; the last log is held out, and of a single one the default blocks."""


def printed_rows() -> list[list[str]]:
    return rows_of("docs/accuracy.md", "| robot | fitted, held out |")


def rows_of(page: str, head: str) -> list[list[str]]:
    """Give the cells of the one table of a page whose head begins so."""
    text = (ROOT / page).read_text(encoding="utf-8")
    (table,) = re.findall(rf"^{re.escape(head)}.*?\n\n", text, re.DOTALL | re.MULTILINE)
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in table.strip().splitlines()[2:]]


def test_the_table_has_the_rows_that_are_made_here():
    assert len(printed_rows()) == len(ROWS)


def test_the_table_of_the_readme_shortens_the_one_of_the_page():
    """Its rows hold the first two of every robot: error of all joints, and band of the held-out motion."""
    rows = printed_rows()
    firsts = [place for place, row in enumerate(rows) if row[0]]
    shown = rows_of("README.md", "| robot | error at the default band |")
    assert len(shown) == len(firsts) == 4
    for (robot, *errors), first in zip(shown, firsts, strict=True):
        assert rows[first][0].startswith(robot)
        bands = [row[2].split("; ")[-1] for row in rows[first : first + 2]]
        totals = [row[4] for row in rows[first : first + 2]]
        assert errors == [f"{total} % ({band} Hz)" for total, band in zip(totals, bands, strict=True)]


@pytest.mark.parametrize("number", range(len(ROWS)))
def test_every_row_of_the_accuracy_table_can_be_made_again(number):
    name, cuts, options = ROWS[number]
    _, _, band, percents, total = printed_rows()[number]
    logs = tuple(measured_log(name, *cut) for cut in cuts)
    made = identified(name, *logs, held_out=len(logs) if len(logs) > 1 else None, **options)
    assert made["feasibility"]["feasible"]
    assert made["validation_total_percent"] == pytest.approx(float(total), abs=PRINTED)
    found = [row["nrmse_of_rms_percent"] for row in made["validation"]]
    assert found == pytest.approx([float(one) for one in percents.split()], abs=PRINTED)
    bands = {float(one) for one in re.findall(r"[\d.]+", band)}
    used = [log["filter"]["cutoff_hz"] for log in made["logs"]]
    assert all(min(abs(one - each) for each in bands) < 0.5 for one in used)
