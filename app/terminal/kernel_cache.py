"""Know where compiled kernels are kept, and say so where the first computation has to compile them."""

import os
from pathlib import Path

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
