"""Compute on one thread of linear algebra, unless who runs the process has decided otherwise.

The matrices are small: more threads multiply the processor time of a study by three, wait for each other on a
busy machine, and add numbers in an order that depends on their count.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager

VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""By these the libraries learn, when they are loaded, how many threads to use."""


@contextmanager
def on_one_thread() -> Iterator[None]:
    """Let linear algebra use one thread inside; as many as one of the variables says where it is set."""
    if any(name in os.environ for name in VARIABLES):
        yield
        return
    from threadpoolctl import threadpool_limits

    with threadpool_limits(limits=1):
        yield
