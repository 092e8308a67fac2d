"""Carry requests to one service and its answers back; every failure on the way is one of ours.

Source: RFC 9457, Problem Details for HTTP APIs; RFC 6750, The OAuth 2.0 Bearer Token.
"""

import json
from collections.abc import Iterable, Iterator
from typing import Any, Final
from urllib.parse import quote, urlsplit

import httpx2

from .errors import NoAnswerError, RefusedError, from_problem

Document = dict[str, Any]
SILENCE_S: Final = 45.0
"""Longest silence between two events; the service breaks it three times as often."""


def segment(name: str) -> str:
    """Write an id or a name as one step of a path.

    Examples
    --------
    >>> segment("my arm?")
    'my%20arm%3F'
    """
    return quote(name, safe="")


class Transport:
    """Reach one service.

    Parameters
    ----------
    url
        Address of the service, ``http://127.0.0.1:8000``, with the path below which it is served, if any.
    key
        Secret of a key; None where the service needs none.
    timeout_s
        Longest wait for one answer, s.

    Raises
    ------
    NoAnswerError
        If this is not the address of a service, or what is given as a key cannot be one.
    """

    def __init__(self, url: str, key: str | None, *, timeout_s: float) -> None:
        if not _is_address(url):
            raise NoAnswerError(
                f"{url!r} is not the address of a service", remedy="give http://host:port or https://host"
            )
        if key and not (key.isascii() and key.isprintable()):
            raise NoAnswerError(
                "the key holds characters that no key has",
                evidence={"characters": len(key)},
                remedy="copy it again, as `veritorque keys create` printed it",
            )
        self.url = url.rstrip("/")
        headers = {"Accept": "application/json"} | ({"Authorization": f"Bearer {key}"} if key else {})
        self._http = httpx2.Client(base_url=self.url, headers=headers, timeout=timeout_s)

    def close(self) -> None:
        """Close the connections."""
        self._http.close()

    def document(
        self,
        method: str,
        path: str,
        *,
        params: dict[str, str] | None = None,
        content: bytes | Iterable[bytes] | None = None,
        media_type: str = "",
    ) -> Document:
        """Send a request and read its answer as a JSON object; an empty one where the answer has no body.

        Raises
        ------
        NoAnswerError
            If there is no answer, or not with JSON.
        RefusedError
            If the service says no.
        """
        headers = {"Content-Type": media_type} if media_type else {}
        answer = self._send(method, path, params=params, content=content, headers=headers)
        return _object(answer) if answer.content else {}

    def content(self, path: str) -> bytes:
        """Fetch bytes as they are.

        Raises
        ------
        NoAnswerError, RefusedError
            As for `document`.
        """
        return self._send("GET", path, headers={"Accept": "*/*"}).content

    def events(self, path: str, last: str) -> Iterator[tuple[str, Document]]:
        """Give the events of a stream with their ids, from the one after `last` until the service ends it.

        Raises
        ------
        NoAnswerError
            If the stream breaks, or what comes is no stream of events.
        RefusedError
            If the service says no.
        """
        headers = {"Last-Event-ID": last} if last else {}
        timeout = httpx2.Timeout(self._http.timeout.connect, read=SILENCE_S)
        try:
            with self._http.sse(path, headers=headers, timeout=timeout) as source:
                if source.response.status_code == 204:
                    return
                if source.response.is_error:
                    source.response.read()
                    raise _refusal(source.response)
                for event in source:
                    if event.data:
                        yield event.id, json.loads(event.data)
        except (httpx2.HTTPError, ValueError) as error:
            raise self._unreachable(error) from error

    def _send(self, method: str, path: str, **more: Any) -> httpx2.Response:  # noqa: ANN401  # as httpx2 takes it
        try:
            answer = self._http.request(method, path, **more)
        except httpx2.HTTPError as error:
            raise self._unreachable(error) from error
        if not answer.is_success:
            raise _refusal(answer)
        return answer

    def _unreachable(self, error: Exception) -> NoAnswerError:
        return NoAnswerError(
            f"the service at {self.url} does not answer",
            evidence={"reason": str(error) or type(error).__name__},
            remedy="start it with: veritorque serve, or correct the address",
        )


def _is_address(url: str) -> bool:
    try:
        parts = urlsplit(url)
        return parts.scheme in {"http", "https"} and bool(parts.hostname) and parts.port != 0
    except ValueError:  # brackets that do not close, a port that is no number
        return False


def _refusal(answer: httpx2.Response) -> RefusedError | NoAnswerError:
    """Read an answer that is no success; what is no problem document does not come from the service."""
    if answer.headers.get("content-type", "").startswith("application/problem+json"):
        return from_problem(RefusedError, _object(answer))
    return NoAnswerError(
        f"what answers at {answer.url} is not the service, or something stands before it",
        evidence={"status": answer.status_code, "media_type": answer.headers.get("content-type", "")},
        remedy="correct the address, or ask whoever runs the proxy",
    )


def _object(answer: httpx2.Response) -> Document:
    try:
        document = answer.json()
    except ValueError:
        document = None
    if not isinstance(document, dict):
        raise NoAnswerError(
            f"what answers at {answer.url} does not answer as the service does",
            evidence={"status": answer.status_code, "media_type": answer.headers.get("content-type", "")},
            remedy="correct the address",
        )
    return document
