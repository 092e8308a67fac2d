"""Write JSON in the two ways the service needs: in order for readers, sorted for hashes; neither holds NaN.

RFC 8259 leaves the order of names open. A reader expects name, value, unit; a hash must not depend on the
order in which a client wrote its description.
"""

import json
import math
from collections.abc import Mapping, Sequence

LONGEST_TEXT = 500
LONGEST_LIST = 50


def json_bytes(document: object) -> bytes:
    """Write a document as JSON with its names in the order they were put in, and no spaces.

    Examples
    --------
    >>> json_bytes({"name": "ZZR1", "joint": 1})
    b'{"name":"ZZR1","joint":1}'
    """
    return json.dumps(document, separators=(",", ":"), allow_nan=False).encode()


def canonical_json(document: object) -> bytes:
    """Write a document for hashing: its names are sorted, so that equal documents are equal bytes.

    Examples
    --------
    >>> canonical_json({"b": [1, 2.5], "a": None})
    b'{"a":null,"b":[1,2.5]}'
    """
    return json.dumps(document, sort_keys=True, separators=(",", ":"), allow_nan=False).encode()


def plain(value: object) -> object:
    """Turn evidence into JSON: arrays to lists, non-finite numbers to words, long texts and lists cut.

    Examples
    --------
    >>> plain({"row": (1, float("nan"))})
    {'row': [1, 'nan']}
    """
    if isinstance(value, bool | int | None):
        return value
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else str(float(value))
    if isinstance(value, str):
        return _cut(value)
    if isinstance(value, Mapping):
        return dict(zip(map(str, value), map(plain, value.values()), strict=True))
    if isinstance(value, Sequence | set | frozenset):
        return list(map(plain, list(value)[:LONGEST_LIST]))
    listed = getattr(value, "tolist", None)  # numpy arrays and scalars
    return _cut(str(value)) if listed is None else plain(listed())


def _cut(text: str) -> str:
    return text if len(text) <= LONGEST_TEXT else text[:LONGEST_TEXT] + " ..."
