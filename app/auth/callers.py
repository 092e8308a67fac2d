"""Find out who asks: the tenant and the scopes of the key that a request carries.

A key without the scope to write is refused before anything else is checked. Without keys, which is possible
on loopback only, everybody is the one local tenant. Source: RFC 6750, The OAuth 2.0 Bearer Token, 2 and 3.
"""

from dataclasses import dataclass

from starlette.requests import Request

from ..problems import Problem
from ..settings import LOCAL, SCOPES
from ..store.keys import KeyRecord
from .keys import KeyRing

SAFE_METHODS = ("GET", "HEAD", "OPTIONS")
CHALLENGE = {"WWW-Authenticate": 'Bearer realm="veritorque"'}


@dataclass(frozen=True)
class Caller:
    """Identify a caller: the tenant, what the key permits, and the key where there is one."""

    tenant: str
    scopes: tuple[str, ...]
    key: KeyRecord | None = None


EVERYBODY = Caller(LOCAL, SCOPES)


def caller_of(request: Request, keys: KeyRing, *, open_to_all: bool) -> Caller:
    """Give who asks.

    Raises
    ------
    Problem
        If the request carries no key that is known (401), or one that does not permit it (403).
    """
    scheme, _, secret = request.headers.get("authorization", "").partition(" ")
    if scheme.lower() != "bearer" or not secret:
        if open_to_all:
            return EVERYBODY
        raise _unknown("the request carries no key")
    key = keys.find(secret.strip())
    if key is None:
        raise _unknown("the request's key is not known, or was revoked")
    caller = Caller(key.tenant, key.scopes, key)
    require_scope(caller, "read" if request.method in SAFE_METHODS else "write")
    return caller


def require_scope(caller: Caller, scope: str) -> None:
    """Return where the caller's key permits it.

    Raises
    ------
    Problem
        If it does not (403).
    """
    if scope not in caller.scopes:
        raise Problem(
            "no-scope",
            f"the key {caller.key.name if caller.key else ''} does not permit to {scope}",
            evidence={"needed": scope, "scopes": list(caller.scopes)},
            remedy="use a key with this scope; the operator makes one with: veritorque keys create --scopes",
        )


def _unknown(cause: str) -> Problem:
    return Problem(
        "no-key",
        cause,
        remedy="send it as Authorization: Bearer ...; the operator makes one with: veritorque keys create",
        headers=CHALLENGE,
    )
