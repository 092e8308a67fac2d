"""Limit the threads of linear algebra, before it is loaded."""

import os


def limit_threads(cpus: int) -> None:
    """Let linear algebra use a thread per CPU of a computation, unless the operator has decided otherwise.

    The matrices are small: more threads double the CPU time of a job, wait for each other on a busy machine,
    and add numbers in an order that depends on their count. Arrow shall not reserve memory that it does not
    use, because what a computation may use is counted. It has to stand before numpy is loaded.
    """
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, str(cpus))
    os.environ.setdefault("ARROW_DEFAULT_MEMORY_POOL", "system")
