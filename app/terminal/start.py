"""Start the command line so early that Ctrl-C is handled while modules are being loaded.

Until the handler is set it loads next to nothing. It gives every stream a place of its own: where one was
closed, its number would otherwise go to the next file that is opened.
"""

import errno
import io
import os
import sys


class Closed(io.RawIOBase):
    """Stand for a standard output that was closed: whatever is written to it is refused, as by the system."""

    def writable(self) -> bool:
        """Return that it can be written to, as for any standard output."""
        return True

    def write(self, _content: object) -> int:
        """Refuse.

        Raises
        ------
        OSError
            Always.
        """
        raise OSError(errno.EBADF, os.strerror(errno.EBADF))


def main() -> None:
    """Run the command line."""
    try:
        from .interruption import handle_interrupts_early

        handle_interrupts_early()
    except KeyboardInterrupt:
        os._exit(130)
    _hold_streams()
    from .main import main as run

    run()


def _hold_streams() -> None:
    while (number := os.open(os.devnull, os.O_RDWR)) <= 2:
        pass
    os.close(number)
    if sys.stdout is None:
        sys.stdout = io.TextIOWrapper(Closed(), encoding="utf-8", write_through=True)
    if sys.stderr is None:
        sys.stderr = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
