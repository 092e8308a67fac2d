"""Hold the report's numbers: JSON always, ten digits, nothing that is not finite."""

import json
from dataclasses import dataclass

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from veritorque.core.document.numbers import DIGITS, plain


@dataclass(frozen=True)
class _Row:
    value: float
    parts: tuple[float, ...]


@given(st.floats(-1e300, 1e300) | st.sampled_from([np.inf, -np.inf, np.nan]))
def test_a_number_keeps_ten_digits_or_is_null(value):
    shown = plain(value)
    json.dumps(shown, allow_nan=False)
    if np.isfinite(value):
        assert abs(shown - value) <= 0.51 * 10.0 ** (1 - DIGITS) * abs(value)
        assert plain(shown) == shown
    else:
        assert shown is None


def test_everything_that_a_chapter_gives_becomes_plain_data():
    given_data = {
        "row": _Row(np.float64(0.1), (1.0, np.inf)),
        "array": np.array([[1.0, np.nan]]),
        "counts": np.array([1, 2]),
        "flag": np.array([True])[0],
        1: None,
        "text": "a",
    }
    assert plain(given_data) == {
        "row": {"value": 0.1, "parts": [1.0, None]},
        "array": [[1.0, None]],
        "counts": [1, 2],
        "flag": True,
        "1": None,
        "text": "a",
    }
    assert type(plain(np.int64(3))) is int
    assert type(plain(np.array([False])[0])) is bool
