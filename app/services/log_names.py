"""Name logs: of this the terminal asks no store, which loads the database's library."""

from pathlib import PurePath

LONGEST_NAME = 200


def log_name(given: str) -> str:
    r"""Make a log's name of what a client calls it: the last part of a path, printable and not too long.

    Examples
    --------
    >>> log_name("C:\\runs\\run 1.csv"), log_name("")
    ('run 1.csv', 'log')
    """
    last = PurePath(given.replace("\\", "/")).name
    return "".join(letter for letter in last if letter.isprintable())[:LONGEST_NAME] or "log"
