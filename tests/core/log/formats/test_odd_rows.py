"""Whole blocks of regular rows are recognised at once; what is found does not depend on where blocks end."""

import numpy as np
import pytest

from veritorque.core.log.formats import odd_rows
from veritorque.core.log.formats.delimited import open_delimited

DAMAGE = {
    "none": lambda lines, at: None,
    "a cut row": lambda lines, at: lines.__setitem__(at, lines[at][:7]),
    "a cell too many": lambda lines, at: lines.__setitem__(at, lines[at] + ",1"),
    "cells that moved a line": lambda lines, at: lines.__setitem__(
        slice(at, at + 2), [lines[at] + ",1", lines[at + 1].rpartition(",")[0]]
    ),
    "an empty line": lambda lines, at: lines.insert(at, ""),
    "a comment": lambda lines, at: lines.insert(at, "# paused, here, for, long"),
    "a quotation": lambda lines, at: lines.__setitem__(at, '"' + lines[at].replace(",", '",', 1)),
    "a cut last row": lambda lines, at: lines.__setitem__(-1, "9.9,1"),
    "text below": lambda lines, at: lines.extend(["", "end of the recording"]),
}


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("damage", DAMAGE)
def test_blocks_of_any_size_name_the_same_rows(damage, end, tmp_path, monkeypatch):
    rng = np.random.default_rng(3)
    rows = rng.normal(size=(400, 4)).round(3)
    lines = ["time,q_1,q_2,tau_1", *(",".join(map(str, row)) for row in rows.tolist())]
    DAMAGE[damage](lines, 250)
    path = tmp_path / "log.csv"
    path.write_text(end.join(lines) + ("" if damage == "a cut last row" else end), newline="")
    found = []
    for size in (1 << 20, 997, 64):  # at once; with whole regular blocks beside others; two lines or three
        monkeypatch.setattr(odd_rows, "BLOCK_BYTES", size)
        found.append(open_delimited(path).odd)
    assert found[1] == found[0]
    assert found[2] == found[0]
    harmless = {"none", "an empty line", "a comment", "a quotation"}
    assert bool(found[0].blank or found[0].cut or found[0].below) == (damage not in harmless)
