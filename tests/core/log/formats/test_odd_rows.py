"""Whole blocks of regular rows are recognised at once; what is found does not depend on where blocks end."""

import numpy as np
import pytest

from veritorque.core.errors import LogError
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
    "a comment without separators": lambda lines, at: lines.insert(at, "  % paused"),
    "a comment at the end": lambda lines, at: lines.append("# stopped"),
    "the header once more": lambda lines, at: lines.insert(at, lines[0]),
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
    harmless = {"none", "an empty line", "a quotation", "the header once more"}
    commented = damage.startswith("a comment")
    assert len(found[0].comments) == commented
    odd = found[0].blank or found[0].cut or found[0].below
    assert bool(odd) == (damage not in harmless and not commented)


@pytest.mark.parametrize("mark", ["#", "%"])
@pytest.mark.parametrize("text", ["{} paused", "{} paused, here, for, long", "  {}1,2,3,4"])
def test_a_comment_between_rows_is_left_out_whatever_separators_it_holds(mark, text, tmp_path):
    lines = [f"{0.01 * k:.2f},{k % 7},{k % 5},1" for k in range(300)]
    whole, commented = tmp_path / "whole.csv", tmp_path / "commented.csv"
    whole.write_text("\n".join(["time,q_1,q_2,tau_1", *lines]) + "\n")
    lines.insert(120, text.format(mark))
    commented.write_text("\n".join(["time,q_1,q_2,tau_1", *lines]) + "\n")
    rows, expected = (
        np.hstack(list(table.batches(table.names)))
        for table in (open_delimited(commented), open_delimited(whole))
    )
    np.testing.assert_array_equal(rows, expected)
    assert open_delimited(commented).notes == ("1 comment between the rows left out (line 122)",)


@pytest.mark.parametrize(("regular", "odd", "whole"), [(400, 8, True), (30, 40_000, False)])
def test_rows_of_another_length_are_counted_of_the_rows_that_were_read(regular, odd, whole, tmp_path):
    path = tmp_path / "log.csv"
    rows = [*["0.01,1,2,3"] * (regular // 2), *["0.12,0.25,0.31,0.43,0.55"] * odd]
    path.write_text("\n".join(["time,q_1,q_2,tau_1", *rows, *["0.01,1,2,3"] * (regular // 2)]) + "\n")
    with pytest.raises(LogError, match="rows are of another length") as refused:
        open_delimited(path)
    seen = refused.value.evidence
    if whole:
        assert (seen["rows_of_another_length"], seen["rows"]) == (odd, regular + odd)
        assert f"{odd} of {regular + odd} rows" in refused.value.cause
    else:
        assert seen["rows_of_another_length"] <= seen["rows_counted"] < regular + odd
        assert f"of the first {seen['rows_counted']} rows" in refused.value.cause
