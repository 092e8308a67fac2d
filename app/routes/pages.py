"""Serve the pages that people read: shells without data, and the files of which they are made.

A shell holds nothing of anybody, so it is given to everybody; its scripts ask the API for what they show,
with a key where one is needed. Nothing is asked of any other place.
"""

from fastapi import APIRouter, Request, Response
from fastapi.responses import HTMLResponse

from ..http.negotiation import matches
from ..pages.files import PLAIN, STATIC, STRICT, PageFile, shell
from ..problems import Problem

ROUTER = APIRouter(include_in_schema=False)


@ROUTER.get("/")
def start_page() -> HTMLResponse:
    """Show the ways in, and the latest jobs."""
    return HTMLResponse(shell("start"), headers=STRICT)


@ROUTER.get("/new")
def new_page() -> HTMLResponse:
    """Lead from a robot and a log to a job."""
    return HTMLResponse(shell("new"), headers=STRICT)


@ROUTER.get("/studies/{job_id}")
def study_page(job_id: str) -> HTMLResponse:  # noqa: ARG001  (the script reads it from the address)
    """Show one job: how far it is, or what came out."""
    return HTMLResponse(shell("study"), headers=STRICT)


@ROUTER.get("/compare")
def compare_page() -> HTMLResponse:
    """Show two studies side by side."""
    return HTMLResponse(shell("compare"), headers=STRICT)


@ROUTER.get("/docs")
def docs_page() -> HTMLResponse:
    """Show the contract in Swagger UI."""
    return HTMLResponse(shell("docs"), headers=PLAIN)


@ROUTER.get("/static/{name:path}")
def static_file(name: str, request: Request) -> Response:
    """Send one of the known files, packed where that is understood, unless the browser has it."""
    if name not in STATIC:
        raise Problem("not-found", f"there is no file {name}", evidence={"known": list(STATIC)})
    file: PageFile = STATIC[name]
    packed = "gzip" in request.headers.get("accept-encoding", "")
    etag = f'"{file.sha256}-gzip"' if packed else f'"{file.sha256}"'
    headers = {"ETag": etag, "Cache-Control": "no-cache", "Vary": "Accept-Encoding"}
    if matches(request.headers.get("if-none-match"), etag):
        return Response(status_code=304, headers=headers)
    if packed:
        return Response(
            file.packed, media_type=file.media_type, headers=headers | {"Content-Encoding": "gzip"}
        )
    return Response(file.content(), media_type=file.media_type, headers=headers)
