"""Say what Ctrl-C means: before a command has begun nothing is to be tidied up, and the process just ends."""

import os
import signal
from typing import NoReturn

INTERRUPTED = 130


def exit_now(*_: object) -> NoReturn:
    """End at once, so that no half-loaded module prints a traceback."""
    os.write(2, b"interrupted\n")
    os._exit(INTERRUPTED)


def handle_interrupts_early() -> None:
    """End at once on Ctrl-C, unless the caller has set the process to ignore it."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, exit_now)


def raise_interrupts() -> None:
    """Let Ctrl-C be a `KeyboardInterrupt` from now on, on which a command tidies up."""
    if signal.getsignal(signal.SIGINT) is exit_now:
        signal.signal(signal.SIGINT, signal.default_int_handler)
