"""Load commands when they are asked for, and turn whatever stops one into words and an exit code.

A command that needs no solver does not wait for it, and no user sees a traceback.
"""

import errno
import tempfile
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer
from typer.core import TyperGroup
from typer.main import get_command

from ...core.errors import VeritorqueError
from .interruption import raise_interrupts
from .output.exit_codes import Exit, exit_of, exit_of_error
from .output.streams import complain, note

NO_ROOM = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})


class Commands(TyperGroup):
    """Hold commands that are loaded when they are called; `load` finds them."""

    def load(self, name: str) -> typer.Typer | None:
        """Load the `typer.Typer` that holds a command, or is that single command; None for unknown names."""
        raise NotImplementedError

    def get_command(self, _ctx: Any, cmd_name: str) -> Any:  # noqa: ANN401  # typer's own, private
        """Load a command; None where there is none of this name."""
        commands = self.load(cmd_name)
        if commands is None:
            return None
        loaded = get_command(commands)
        found = getattr(loaded, "commands", {}).get(cmd_name, loaded)
        found.name = cmd_name
        raise_interrupts()
        return found

    def make_context(self, *arguments: Any, **more: Any) -> Any:  # noqa: ANN401  # typer's own, private
        """Read the command line; whatever stops that becomes words and an exit code."""
        with exit_on_error():
            return super().make_context(*arguments, **more)

    def invoke(self, ctx: Any) -> Any:  # noqa: ANN401  # typer's own, private
        """Run a command; whatever stops it becomes words and an exit code."""
        with exit_on_error():
            return super().invoke(ctx)


@contextmanager
def exit_on_error() -> Iterator[None]:
    """Turn errors into words and an exit code."""
    try:
        yield
    except VeritorqueError as error:
        complain(error.cause, error.evidence, error.remedy)
        raise typer.Exit(exit_of_error(error)) from None
    except KeyboardInterrupt:
        note("interrupted")
        raise typer.Exit(Exit.INTERRUPTED) from None
    except BrokenPipeError:
        raise typer.Exit(Exit.DONE) from None  # the reader has closed the pipe
    except Exception as error:
        if _is_typers(error):
            raise
        raise typer.Exit(_other(error)) from None


def _other(error: Exception) -> Exit:
    from ..problems import Problem

    if isinstance(error, Problem):
        complain(str(error.detail), error.evidence, error.remedy)
        return exit_of(error.kind)
    if isinstance(error, OSError) and error.errno == errno.EBADF and not error.filename:
        complain(
            "standard output is closed",
            {"reason": error.strerror},
            "keep it open, or redirect it to a file or to /dev/null",
        )
        return Exit.INPUT
    if isinstance(error, OSError) and error.errno in NO_ROOM:
        complain(
            "no space left on the device",
            {"reason": error.strerror, "where": error.filename or "standard output, or a temporary file"},
            "free space, or write elsewhere; TMPDIR sets the folder of temporary files",
        )
        return Exit.INPUT
    with tempfile.NamedTemporaryFile(
        "w", prefix="veritorque-", suffix=".txt", delete=False, encoding="utf-8"
    ) as file:
        file.write("".join(traceback.format_exception(error)))
    complain(
        "internal error", {"what": f"{type(error).__name__}: {error}"}, f"report it with {Path(file.name)}"
    )
    return Exit.MISTAKE


def _is_typers(error: Exception) -> bool:
    """Return whether an error is one that typer handles itself."""
    return type(error).__module__.split(".")[0] in {"typer", "click"}
