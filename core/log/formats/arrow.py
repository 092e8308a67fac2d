"""Take numbers out of Arrow without `Array.to_numpy`, which loads pandas wherever pandas is installed.

That takes longer than reading a log, and a process that may open nothing any more could not do it at all.
"""

import numpy as np
import pyarrow as pa
import pyarrow.csv as arrow_csv

from ...arrays import Samples

ABSENT = (
    "None", "none", "NONE", "Null", "NaT", "NAN", "-NAN", "<NA>", "-", "--", "---", "?", "nan(ind)",
    "-nan(ind)",
)  # fmt: skip  # a table
"""What recorders write for a missing value, beside the usual words."""
WIDEST_BLANK = 32


def words_for_nothing() -> list[str]:
    """List what stands for a missing value in text, also behind a blank.

    Examples
    --------
    >>> {"", "nan", "None", " nan", "   "} <= set(words_for_nothing())
    True
    """
    words = [*arrow_csv.ConvertOptions().null_values, *ABSENT]
    blanks = [" " * width for width in range(2, WIDEST_BLANK + 1)]
    return [*words, *(f" {word}" for word in words), *blanks]


def numbers(column: pa.Array) -> Samples:
    """Give a column of numbers as float64; what is missing is NaN.

    Examples
    --------
    >>> numbers(pa.array([1, None, 3]))
    array([ 1., nan,  3.])
    """
    if column.type != pa.float64():
        column = column.cast(pa.float64(), safe=False)  # beyond 2^53 to the nearest, as numpy does
    if column.null_count:
        column = column.fill_null(np.nan)
    return np.asarray(np.from_dlpack(column))
