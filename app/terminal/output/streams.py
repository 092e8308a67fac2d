"""Speak to a terminal: results on standard output, everything else on standard error, plain where piped."""

import sys
from collections.abc import Iterable, Mapping
from io import TextIOWrapper
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from rich.console import Console

MOST_PARTS = 4
"""Named parts of what was seen that are written out; documents hold all."""
PIPED_WIDTH = 200
"""Columns where the output is no terminal: lines are not folded, so that a table keeps one row a line."""


def escape_unknown_characters() -> None:
    """Write characters that the encoding lacks as escapes, so that no name of a file stops a command."""
    if isinstance(sys.stdout, TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")


def result_console() -> "Console":
    """Give the console for results."""
    return _console(error=False)


def error_console() -> "Console":
    """Give the console for progress, notes and errors."""
    return _console(error=True)


def echo(text: str) -> None:
    """Write a line of a result as it is."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def note(text: str) -> None:
    """Write a line beside the result."""
    sys.stderr.write(text + "\n")


def note_suspicions(suspicions: Iterable[str]) -> None:
    """Write what is probably wrong in a robot's description, before anything is computed from it."""
    for suspicion in suspicions:
        note(f"warning: {suspicion}")


def write(content: bytes) -> None:
    """Write bytes to standard output and nothing else, but for a line's end where somebody watches."""
    sys.stdout.flush()
    sys.stdout.buffer.write(content)
    if sys.stdout.isatty():
        sys.stdout.buffer.write(b"\n")
    sys.stdout.buffer.flush()


def complain(cause: str, evidence: Mapping[str, object], remedy: str) -> None:
    """Say on standard error what is wrong, what was seen, and what to do about it."""
    note(f"error: {cause}")
    for name, value in evidence.items():
        note(f"  {name.replace('_', ' ')}: {_value_text(value)}")
    if remedy:
        note(f"  remedy: {remedy}")


def _console(*, error: bool) -> "Console":
    from rich.console import Console

    class PipeConsole(Console):
        """Raise on a closed pipe, where rich would end the program with 1."""

        def on_broken_pipe(self) -> NoReturn:
            raise BrokenPipeError

    console = PipeConsole(stderr=error, highlight=False)
    if not console.is_terminal:
        console.width = PIPED_WIDTH
    return console


def _value_text(value: object) -> str:
    if isinstance(value, Mapping):
        parts = [f"{name}: {_value_text(entry)}" for name, entry in value.items()]
        more = len(parts) - MOST_PARTS
        return "; ".join(parts[:MOST_PARTS] + ([f"and {more} more"] if more > 0 else [])) or "none"
    if isinstance(value, list | tuple):
        return ", ".join(_value_text(entry) for entry in value) or "none"
    return str(value)
