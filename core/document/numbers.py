"""Round numbers for a reader, and keep them JSON: the only place where either happens.

Ten significant digits are far beyond any parameter's precision and hide the last bits that differ between
processors.
"""

from collections.abc import Mapping
from dataclasses import asdict, is_dataclass

import numpy as np

DIGITS = 10


def plain(value: object) -> object:
    """Give a value as JSON data: arrays as lists, numbers rounded, what is not finite as null.

    Examples
    --------
    >>> plain({"value": np.float64(1.00000000001), "open": float("inf")})
    {'value': 1.0, 'open': None}
    """
    if is_dataclass(value) and not isinstance(value, type):
        value = asdict(value)
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [plain(entry) for entry in value]
    return _scalar(value)


def _scalar(value: object) -> bool | int | float | str | None:
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        shown = float(f"{value:.{DIGITS}g}")
        return shown if np.isfinite(shown) else None
    return value if value is None or isinstance(value, bool | int) else str(value)
