"""Choose among the forms of a resource by what the client accepts, and read how long it is willing to wait.

Sources: RFC 9110, HTTP Semantics (2022), 12.5.1 for Accept and 13.1.2 for If-None-Match; RFC 7240, Prefer.
"""

import re

LONGEST_WAIT_S = 60
_WAIT = re.compile(r"(?:^|[,;\s])wait\s*=\s*\"?(\d{1,6})")


def preferred(accept: str | None, offers: tuple[str, ...]) -> str | None:
    """Choose the offer that a client likes best, the first among equals; None where it likes none.

    Examples
    --------
    >>> preferred("text/html, text/csv;q=0.9, */*;q=0.1", ("application/json", "text/csv"))
    'text/csv'
    """
    if not accept or not accept.strip():
        return offers[0]
    ranges = [_range(part) for part in accept.split(",")]
    scores = {offer: _quality(offer, ranges) for offer in offers}
    best = max(offers, key=lambda offer: scores[offer])
    return best if scores[best] > 0.0 else None


def matches(if_none_match: str | None, etag: str) -> bool:
    """Return whether the client has this version already.

    Examples
    --------
    >>> matches('W/"1", "2"', '"2"'), matches(None, '"2"')
    (True, False)
    """
    tags = [tag.strip().removeprefix("W/") for tag in (if_none_match or "").split(",")]
    return "*" in tags or etag in tags


def wait_seconds(prefer: str | None) -> int | None:
    """Read how long a client is willing to wait, at most 60 s; None where it does not say.

    Examples
    --------
    >>> wait_seconds("respond-async, wait=300"), wait_seconds(None)
    (60, None)
    """
    found = _WAIT.search(prefer or "")
    return None if found is None else min(int(found[1]), LONGEST_WAIT_S)


def _range(part: str) -> tuple[str, float]:
    media, *parameters = (piece.strip().lower() for piece in part.split(";"))
    for parameter in parameters:
        if parameter.startswith("q="):
            try:
                return media, min(max(float(parameter[2:]), 0.0), 1.0)
            except ValueError:
                return media, 0.0
    return media, 1.0


def _quality(offer: str, ranges: list[tuple[str, float]]) -> float:
    """Give the quality of the most specific range which covers the offer."""
    family = offer.split("/", maxsplit=1)[0] + "/*"
    for covering in (offer, family, "*/*"):
        found = [quality for media, quality in ranges if media == covering]
        if found:
            return max(found)
    return 0.0
