"""Say what Ctrl-C means: before a command has begun nothing is to be tidied up, and the process just ends."""

import os
import signal
from typing import NoReturn

INTERRUPTED = 130


def leave(*_: object) -> NoReturn:
    """End at once: no module that is half loaded shall say what it thinks of that."""
    os.write(2, b"interrupted\n")
    os._exit(INTERRUPTED)


def hear_from_the_start() -> None:
    """End at once on Ctrl-C, unless whoever called has told the process to be deaf to it."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, leave)


def let_commands_hear() -> None:
    """Let Ctrl-C be a `KeyboardInterrupt` from now on, on which a command tidies up."""
    if signal.getsignal(signal.SIGINT) is leave:
        signal.signal(signal.SIGINT, signal.default_int_handler)
