"""Accept requests to the service's own names, and none from pages of other sites.

On loopback no key is needed, so that any page that is open in a browser on the same machine could have that
browser send requests for it. Two things stop that: a foreign name that points here is none of the
service's names, and browsers say which site a request comes from. Sources: RFC 9110, 7.2, on Host;
https://www.w3.org/TR/fetch-metadata/ on Sec-Fetch-Site.
"""

import ipaddress
from collections.abc import Iterable
from urllib.parse import urlsplit

from starlette.types import ASGIApp, Receive, Scope, Send

from ..problems import Problem
from .exception_handlers import problem_response

SAFE_METHODS = ("GET", "HEAD", "OPTIONS")
OWN_SITE = (b"same-origin", b"none")
MOST_REMEMBERED = 1000


class HostGuard:
    """Refuse requests that are meant for another host, or come from a page of another site.

    Parameters
    ----------
    app
        What comes next.
    hosts
        Names of the service; addresses and localhost are taken anyway.
    """

    def __init__(self, app: ASGIApp, hosts: Iterable[str]) -> None:
        self._app = app
        self._names = {"localhost", *(host.lower().rstrip(".") for host in hosts)}
        self._known: set[bytes] = set()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request."""
        refusal = self._refusal(scope) if scope["type"] == "http" else None
        if refusal is None:
            await self._app(scope, receive, send)
        else:
            await problem_response(refusal)(scope, receive, send)

    def _refusal(self, scope: Scope) -> Problem | None:
        hosts = _hosts(scope)
        if len(hosts) != 1:
            return None if scope["http_version"] == "1.0" and not hosts else _no_host(len(hosts))
        if not self._knows(hosts[0]):
            return _not_ours(hosts[0].decode("latin-1"))
        if scope["method"] not in SAFE_METHODS and _from_elsewhere(scope, hosts[0]):
            return _other_site()
        return None

    def _knows(self, host: bytes) -> bool:
        """Tell whether a host is one of ours, and remember it."""
        known = host in self._known or self._is_ours(host.decode("latin-1"))
        if known and len(self._known) < MOST_REMEMBERED:
            self._known.add(host)
        return known

    def _is_ours(self, host: str) -> bool:
        try:
            parts = urlsplit(f"//{host}")
            name = (parts.hostname or "").rstrip(".")
            if parts.netloc != host or parts.username is not None or (parts.port or 0) < 0:
                return False
        except ValueError:
            return False
        return name in self._names or _is_address(name)


def _hosts(scope: Scope) -> list[bytes]:
    return [value for name, value in scope["headers"] if name == b"host"]


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _from_elsewhere(scope: Scope, host: bytes) -> bool:
    headers = dict(scope["headers"])
    site = headers.get(b"sec-fetch-site")
    if site is not None:
        return site not in OWN_SITE
    origin = headers.get(b"origin")  # older browsers
    return origin is not None and origin.partition(b"://")[2] != host


def _no_host(count: int) -> Problem:
    return Problem(
        "bad-request",
        "the request says not to which host it goes" if count == 0 else "the request names several hosts",
        evidence={"hosts": count},
        remedy="send one Host header",
    )


def _not_ours(host: str) -> Problem:
    return Problem(
        "wrong-host",
        f"the service is not called {host[:100]}",
        evidence={"host": host},
        remedy="call it by its address, or let the operator add the name to VERITORQUE_HOSTS",
    )


def _other_site() -> Problem:
    return Problem(
        "other-site",
        "the request comes from a page of another site",
        remedy="send it from a program, or from the service's own pages",
    )
