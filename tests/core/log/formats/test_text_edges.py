"""Slips of recorders at the edges of a text table cost nothing: trailing marks, comments, half a row."""

import numpy as np
import pytest

from tests.core.log.formats.test_text import BY_NUMBER, COLUMNS, lines
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_rows_may_end_with_a_separator_that_the_header_lacks(delimiter, tmp_path):
    path = tmp_path / "log.txt"
    header, *rows = lines(delimiter)
    path.write_text("\n".join([header, *(row + delimiter for row in rows)]))
    np.testing.assert_allclose(whole_rows(read_log(path)).torque[:, 1], COLUMNS["tau_2"], atol=1e-9)


@pytest.mark.parametrize("mark", ["% ", "%% ", "// ", "//"])
@pytest.mark.parametrize("delimiter", [" ", ","])
def test_a_header_may_be_a_comment_of_matlab_or_c(mark, delimiter, tmp_path):
    path = tmp_path / "log.txt"
    header, *rows = lines(delimiter)
    path.write_text("\n".join([f"{mark}arm of the lab, run 7", mark + header, *rows]))
    np.testing.assert_allclose(whole_rows(read_log(path)).torque[:, 1], COLUMNS["tau_2"], atol=1e-9)


@pytest.mark.parametrize("delimiter", [" ", ","])
def test_a_comment_of_matlab_stands_above_rows_without_header(delimiter, tmp_path):
    path = tmp_path / "log.txt"
    path.write_text("\n".join(["% arm of the lab run 7", *lines(delimiter, header=False)]))
    log = read_log(path, mapping=BY_NUMBER)
    np.testing.assert_allclose(whole_rows(log).torque[:, 1], COLUMNS["tau_2"], atol=1e-9)


@pytest.mark.parametrize("delimiter", [" ", ",", ";"])
def test_half_a_row_at_the_beginning_is_no_header(delimiter, tmp_path):
    path = tmp_path / "log.txt"
    first, *rows = lines(delimiter, header=False)
    path.write_text("\n".join([first[len(first) // 2 :], *rows]))
    log = read_log(path, mapping=BY_NUMBER)
    np.testing.assert_allclose(whole_rows(log).torque[:, 1], COLUMNS["tau_2"][1:], atol=1e-9)
