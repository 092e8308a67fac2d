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
    if isinstance(value, bool | np.bool_):
        return bool(value)
    if isinstance(value, int | np.integer):
        return int(value)
    if isinstance(value, float | np.floating):
        return float(f"{value:.{DIGITS}g}") if np.isfinite(value) else None
    if isinstance(value, Mapping):
        return {str(key): plain(one) for key, one in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [plain(one) for one in value]
    if is_dataclass(value) and not isinstance(value, type):
        return plain(asdict(value))
    return value if value is None else str(value)
