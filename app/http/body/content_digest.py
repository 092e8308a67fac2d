"""Check that a body arrives as it was sent, where its sender announces a digest.

The digest covers the body as it travels, a form with its boundaries included; an upload that was corrupted on
the way is refused before anything is made of it. Source: RFC 9530, Digest Fields (2024), sections 2 and 5.
"""

import base64
import binascii
import hashlib
import hmac
import re

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from ...problems import Problem
from ..exception_handlers import problem_response

HEADER = "Content-Digest"
ALGORITHMS = {"sha-256": "sha256", "sha-512": "sha512"}
_MEMBER = re.compile(r"([a-z*][a-z0-9_.*-]*)=:([A-Za-z0-9+/=]*):(?: *;.*)?")  # parameters say nothing here


class ContentDigest:
    """Hash bodies whose digest is announced, and refuse those that differ.

    Parameters
    ----------
    app
        What comes next.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request."""
        try:
            announced = _stated_digests(scope) if scope["type"] == "http" else {}
        except Problem as problem:
            await problem_response(problem)(scope, receive, send)
            return
        hashes = {name: hashlib.new(ALGORITHMS[name]) for name in announced}

        async def hashed() -> Message:
            message = await receive()
            for seen in hashes.values():
                seen.update(message.get("body", b""))
            if message["type"] == "http.request" and not message.get("more_body", False):
                _compare(announced, hashes)
            return message

        await self._app(scope, hashed if announced else receive, send)


def parse_digests(text: str) -> dict[str, bytes]:
    r"""Read the header; algorithms which are not known are left out, as the standard asks.

    Raises
    ------
    Problem
        If it is not written as the standard demands (400).

    Examples
    --------
    >>> parse_digests("unixsum=:AAA=:, sha-256=:AAAA:")
    {'sha-256': b'\x00\x00\x00'}
    """
    announced = {}
    for part in text.split(","):
        member = _MEMBER.fullmatch(part.strip())
        if member is None:
            raise _unreadable(part.strip())
        name, value = member.groups()
        if name in ALGORITHMS:
            try:
                whole = value + "=" * (-len(value) % 4)  # the end may be left out (RFC 8941, 4.2.7)
                announced[name] = base64.b64decode(whole, validate=True)
            except binascii.Error:
                raise _unreadable(part.strip()) from None
    return announced


def _stated_digests(scope: Scope) -> dict[str, bytes]:
    given = [value.decode("latin-1") for name, value in scope["headers"] if name == HEADER.lower().encode()]
    return parse_digests(", ".join(given)) if given else {}


def _compare(announced: dict[str, bytes], hashes: dict[str, "hashlib._Hash"]) -> None:
    for name, seen in hashes.items():
        if not hmac.compare_digest(seen.digest(), announced[name]):
            raise _mismatch(name, announced[name], seen.digest())


def _unreadable(part: str) -> Problem:
    return Problem(
        "digest",
        f"the header {HEADER} cannot be read",
        evidence={"given": part[:200], "known": list(ALGORITHMS)},
        remedy=f"write it as RFC 9530 does, such as {HEADER}: sha-256=:<base64>:",
    )


def _mismatch(name: str, announced: bytes, seen: bytes) -> Problem:
    return Problem(
        "digest",
        "the body that arrived is not the one that was announced",
        evidence={
            "algorithm": name,
            "announced": base64.b64encode(announced).decode(),
            "arrived": base64.b64encode(seen).decode(),
        },
        remedy="send it again; if it differs again, compute the digest of exactly the bytes of the body",
    )
