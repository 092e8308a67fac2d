"""Talk to the service over HTTP with nothing but the standard library: upload, ask, wait, fetch.

A problem document becomes a `ServiceError` with the same cause, evidence and remedy, so that a caller prints
what to do.
"""

import json
import time
from collections.abc import Callable
from http.client import HTTPConnection, HTTPException, HTTPSConnection
from pathlib import Path
from typing import Any, Final
from urllib.parse import quote, urlsplit

Document = dict[str, Any]
ENDED: Final = frozenset({"successful", "failed", "dismissed"})
MEDIA_TYPES: Final = {
    ".csv": "text/csv",
    ".parquet": "application/vnd.apache.parquet",
    ".npz": "application/x-npz",
    ".mat": "application/x-matlab-data",
}


class ServiceError(Exception):
    """Say why the service did not do as asked: cause, evidence and remedy, as in its problem document."""

    def __init__(self, cause: str, *, evidence: Document | None = None, remedy: str = "") -> None:
        super().__init__(cause)
        self.cause = cause
        self.evidence = dict(evidence or {})
        self.remedy = remedy

    @classmethod
    def from_problem(cls, problem: Document) -> "ServiceError":
        """Read a problem document; `detail` or `title` stand in for a cause that is missing."""
        cause = problem.get("cause") or problem.get("detail") or problem.get("title") or "no reason was given"
        return cls(str(cause), evidence=problem.get("evidence"), remedy=str(problem.get("remedy") or ""))


class Client:
    """Reach one service.

    Parameters
    ----------
    url
        Address of the service, ``http://127.0.0.1:8000``.
    timeout
        Longest wait for one answer, s.
    """

    def __init__(self, url: str, *, timeout: float = 60.0) -> None:
        parts = urlsplit(url)
        if parts.scheme not in {"http", "https"} or not parts.hostname:
            raise ServiceError(f"{url} is not the address of a service", remedy="give http://host:port")
        self.url = url.rstrip("/")
        self._connection = HTTPSConnection if parts.scheme == "https" else HTTPConnection
        self._address = parts.netloc
        self._prefix = parts.path.rstrip("/")
        self._timeout = timeout

    def is_alive(self) -> bool:
        """Tell whether the service answers."""
        try:
            self._request("GET", "/healthz")
        except ServiceError:
            return False
        return True

    def add_robot(self, path: Path) -> str:
        """Create a robot from its description (JSON) or URDF; give its id."""
        media_type = "application/json" if path.suffix == ".json" else "application/xml"
        return str(self._request("POST", "/v1/robots", _read(path), media_type)["id"])

    def add_log(self, path: Path) -> Document:
        """Upload a log; give its summary."""
        media_type = MEDIA_TYPES.get(path.suffix, "text/csv")
        return self._request("POST", f"/v1/logs?name={quote(path.name)}", _read(path), media_type)

    def start(self, kind: str, robot: str, logs: list[str], options: Document | None = None) -> Document:
        """Ask for a computation; give the job."""
        request = {"kind": kind, "robot": robot, "logs": logs, "options": options or {}}
        return self._request("POST", "/v1/jobs", json.dumps(request).encode(), "application/json")

    def wait(self, job: str, tell: Callable[[str, float], None], *, pause: float = 0.1) -> Document:
        """Follow a job to its end, telling stage and fraction (0 to 1); give the result document."""
        while True:
            state = self._request("GET", f"/v1/jobs/{job}")
            progress = state.get("progress") or {}
            tell(str(progress.get("stage") or state["state"]), float(progress.get("fraction") or 0.0))
            if state["state"] in ENDED:
                break
            time.sleep(pause)
        if state["state"] != "successful":
            problem = state.get("problem") or {"cause": f"the job was {state['state']}"}
            raise ServiceError.from_problem(problem)
        return self._request("GET", f"/v1/jobs/{job}/results")

    def report(self, job: str) -> bytes:
        """Fetch a job's report: one HTML file."""
        answer, status = self._send("GET", f"/v1/jobs/{job}/report")
        if status >= 400:
            self._document(answer, status)
        return answer

    def _request(self, method: str, path: str, body: bytes | None = None, media_type: str = "") -> Document:
        return self._document(*self._send(method, path, body, media_type))

    def _send(
        self, method: str, path: str, body: bytes | None = None, media_type: str = ""
    ) -> tuple[bytes, int]:
        headers = {"Accept": "application/json"} | ({"Content-Type": media_type} if media_type else {})
        connection = self._connection(self._address, timeout=self._timeout)
        try:
            connection.request(method, self._prefix + path, body, headers)
            response = connection.getresponse()
            return response.read(), response.status
        except (OSError, HTTPException) as error:
            raise ServiceError(
                f"{self.url} does not answer", evidence={"reason": str(error)}, remedy="start the service"
            ) from error
        finally:
            connection.close()

    def _document(self, answer: bytes, status: int) -> Document:
        try:
            document = json.loads(answer)
        except ValueError:
            document = {}
        if status >= 400:
            raise ServiceError.from_problem({"cause": f"the service answered {status}"} | document)
        return dict(document) if isinstance(document, dict) else {}


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise ServiceError(f"{path} cannot be read", evidence={"reason": error.strerror}) from error
