"""List the runs of marked samples: where each begins and where it ends."""

import numpy as np

from ..arrays import Mask, Runs


def marked_runs(marks: Mask) -> Runs:
    """Give the first sample of every run of marks, and the first one after it.

    Examples
    --------
    >>> marked_runs(np.array([True, True, False, False, True]))
    array([[0, 2],
           [4, 5]])
    """
    return np.flatnonzero(np.diff(marks, prepend=False, append=False)).reshape(-1, 2)
