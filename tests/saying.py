"""Print the lines of a command that runs for long, each as soon as it is known."""

import sys


def say(text: str) -> None:
    """Print one line at once."""
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()
