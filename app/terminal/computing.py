"""Prepare this process for computations: threads of linear algebra, and where compiled kernels are kept."""

import os
from pathlib import Path

from ...core.numerics.threads import VARIABLES

COMPILING = "about 20 s"
"""Of processor time, measured with nothing compiled yet; more by the clock where a machine is busy."""
BESIDE_THE_CODE = Path(__file__).parents[2] / "core" / "regressor" / "__pycache__"


def keep_compiled_kernels(data_dir: Path) -> Path | None:
    """Let numba keep what it compiles in the data directory; give where, if it has not compiled yet."""
    kernels = Path(os.environ.setdefault("NUMBA_CACHE_DIR", str((data_dir / "kernels").resolve())))
    return None if _hold_any(kernels) else kernels


def share_compiled_kernels() -> bool:
    """Let numba use what the service compiled, where one was run from here; tell whether all is compiled."""
    served = Path(os.environ.get("VERITORQUE_DATA_DIR", "data")) / "kernels"
    if served.is_dir():
        os.environ.setdefault("NUMBA_CACHE_DIR", str(served.resolve()))
    return _hold_any(Path(os.environ.get("NUMBA_CACHE_DIR") or BESIDE_THE_CODE))


def _hold_any(kernels: Path) -> bool:
    return any(kernels.rglob("*.nbi"))


def limit_threads(cpus: int) -> None:
    """Let linear algebra use a thread per CPU of a computation, unless the operator has decided otherwise.

    The matrices are small: more threads double the CPU time of a job, wait for each other on a busy machine,
    and add numbers in an order that depends on their count. Arrow shall not reserve memory that it does not
    use, because what a computation may use is counted. It has to stand before numpy is loaded.
    """
    for name in VARIABLES:
        os.environ.setdefault(name, str(cpus))
    os.environ.setdefault("ARROW_DEFAULT_MEMORY_POOL", "system")
