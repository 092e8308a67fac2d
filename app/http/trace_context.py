"""Take over the trace that a request belongs to, so that its story can be followed through several services.

Source: W3C Trace Context, level 1 (2021), section 3.2.
"""

import re
import secrets

_FIELDS = re.compile(r"([0-9a-f]{2})-([0-9a-f]{32})-([0-9a-f]{16})-[0-9a-f]{2}(-.*)?")
_INVALID_VERSION = "ff"
_ONLY_VERSION = "00"
"""The version that has nothing after its four fields."""


def trace_id(traceparent: str | None) -> str:
    """Give the id of the trace that a header names; a new one where it is absent or not valid.

    Examples
    --------
    >>> trace_id("00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01")
    '4bf92f3577b34da6a3ce929d0e0e4736'
    """
    found = _FIELDS.fullmatch(traceparent or "")
    if found is None:
        return secrets.token_hex(16)
    version, trace, parent, more = found.groups()
    valid = version != _INVALID_VERSION and int(trace, 16) and int(parent, 16)
    return trace if valid and not (more and version == _ONLY_VERSION) else secrets.token_hex(16)
