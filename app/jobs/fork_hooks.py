"""Leave it to the worker when a computation ends: loaded by the server that computations are forked from.

Whoever ends a service often tells all of its processes at once, as systemd does. The worker then stops its
computations and hands their jobs back; computations that ended by themselves would look as if they had died.
"""

import signal

signal.signal(signal.SIGTERM, signal.SIG_IGN)
