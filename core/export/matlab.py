"""Write an identified robot as a MATLAB file: one struct, whose rows are struct arrays.

The header's text, where MATLAB writes the time, says the same always: equal results are equal bytes. Source:
MAT-File Format, version 5.
"""

import io

import numpy as np

from ..document.model.caveats import by_identifiability
from ..document.model.identified import IdentifiedRobot
from .content import Row, content

VARIABLE = "identified"
HEADER = b"MATLAB 5.0 MAT-file, identified robot written by Veritorque"
HEADER_BYTES = 116


def write_matlab(identified: IdentifiedRobot) -> bytes:
    """Write a MAT file of version 5, which holds the struct `identified`."""
    from scipy.io import savemat

    document = content(identified)
    document["notes"] = [*_texts(document["notes"]), *by_identifiability(identified)]
    file = io.BytesIO()
    struct = {name: _value(value) for name, value in document.items()}
    savemat(file, {VARIABLE: struct}, long_field_names=True, oned_as="row")  # type: ignore[arg-type]  # a file of ours, held in memory
    return HEADER.ljust(HEADER_BYTES) + file.getvalue()[HEADER_BYTES:]


def _texts(value: object) -> list[str]:
    return [str(entry) for entry in value] if isinstance(value, list) else []


def _value(value: object) -> object:
    """Give lists of rows as struct arrays, of texts as cells, of numbers as matrices; empty as 0 x 0."""
    if not isinstance(value, list):
        return value
    if value and isinstance(value[0], dict):
        return _struct_array(value)
    if value and isinstance(value[0], str):
        return np.array(value, dtype=object)
    return np.array(value, dtype=float)


def _struct_array(rows: list[Row]) -> np.ndarray:
    found = np.empty(len(rows), dtype=[(name, object) for name in rows[0]])
    for index, row in enumerate(rows):
        found[index] = tuple(_number(_value(entry)) for entry in row.values())
    return found


def _number(value: object) -> object:
    return float(value) if isinstance(value, int) else value  # MATLAB's numbers are doubles
