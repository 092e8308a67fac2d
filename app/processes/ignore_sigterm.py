"""Ignore SIGTERM in the fork server and in all processes that are forked from it.

Whoever ends a service often signals all of its processes at once, as systemd does. The worker then stops its
computations and hands their jobs back; computations that ended by themselves would count as crashed. The fork
server preloads this module, because a signal handler has to be set there before the first fork.
"""

import signal

signal.signal(signal.SIGTERM, signal.SIG_IGN)
