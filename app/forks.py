"""Start processes as forks of one server process that has loaded what they need.

Python keeps one such server per process, hence everybody who forks names here what it shall load before the
first fork.
"""

import multiprocessing
from multiprocessing.context import ForkServerContext

_PRELOAD: list[str] = []


def fork_server(*preload: str) -> ForkServerContext:
    """Give the context in which to start processes; the server loads these modules, too, unless it runs."""
    _PRELOAD.extend(name for name in preload if name not in _PRELOAD)
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(list(_PRELOAD))
    return context
