"""Turn long lists page by page: a cursor says where the next page begins, whatever comes and goes."""

from collections.abc import Sequence
from typing import Annotated, Protocol

from fastapi import Query

from .body.json_body import invalid

LARGEST = 2**62
Limit = Annotated[int, Query(ge=1, le=1000)]
CursorOf = Annotated[str | None, Query(max_length=40, description="`next` of the previous page")]


class Listed(Protocol):
    """Have a place in a list."""

    @property
    def sequence(self) -> int | None:
        """Give a number that grows from one to the next; None where it stands before all others."""


def before(cursor: str | None) -> int | None:
    """Read a cursor: the sequence number before which a page begins; None for the first page.

    Raises
    ------
    Problem
        If it is none of ours (422).
    """
    if cursor is None:
        return None
    if not (cursor.isascii() and cursor.isdigit() and int(cursor) <= LARGEST):
        complaint = {"loc": ("query", "cursor"), "msg": "it is no `next` of a page", "input": cursor}
        raise invalid([complaint])
    return int(cursor)


def following(page: Sequence[Listed], limit: int) -> str | None:
    """Write the cursor of the page after this one; None where this one is the last.

    Examples
    --------
    >>> following([], 10) is None
    True
    """
    placed = [record.sequence for record in page if record.sequence is not None]
    return str(placed[-1]) if len(placed) == limit else None
