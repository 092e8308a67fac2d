"""A guess at names and units reads a text once, however many columns it asks for."""

import pytest

from tests.core.log.writers import swing, write_csv
from veritorque.core.errors import LogError
from veritorque.core.log.check import check_log
from veritorque.core.log.formats.delimited import DelimitedTable
from veritorque.core.log.reader import read_log


@pytest.fixture
def renamed(tmp_path):
    columns = swing(joints=7)
    called = {
        name.replace("q_", "ang").replace("tau_", "trq").replace("time", "t"): values
        for name, values in columns.items()
    }
    return write_csv(tmp_path / "renamed.csv", called, " ")


@pytest.mark.parametrize("read", [read_log, lambda path: check_log(path).suggestion])
def test_a_refused_text_is_parsed_once_for_all_its_columns(renamed, monkeypatch, read):
    calls, parse = [], DelimitedTable.batches
    monkeypatch.setattr(DelimitedTable, "batches", lambda *given: calls.append(given) or parse(*given))
    try:
        suggested = read(renamed)
    except LogError as error:
        suggested = error.evidence["suggested_mappings"][0]
    assert suggested["torque"]["columns"] == [f"trq{joint}" for joint in range(1, 8)]
    assert len(calls) == 1


def test_a_column_of_words_hides_no_other(tmp_path):
    path = write_csv(tmp_path / "words.csv", swing(joints=1))
    lines = path.read_text().splitlines()
    path.write_text("\n".join(["t,ang1,trq1,mode", *(f"{line},auto" for line in lines[1:])]))
    assert check_log(path).suggestion["position"] == {"columns": ["ang1"], "unit": "rad"}


def test_a_file_of_words_alone_is_refused_in_words(tmp_path):
    path = tmp_path / "words.csv"
    path.write_text("GET /healthz\nHost: localhost\n\n")
    with pytest.raises(LogError):
        read_log(path)
