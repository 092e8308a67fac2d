"""Serve the pages that people read, from files of our own and without a request to anywhere else."""

from html import escape
from pathlib import Path
from string import Template

from fastapi import APIRouter, Request
from fastapi.responses import FileResponse, HTMLResponse

from app.pages.latest import header_cells, job_rows
from app.problems import Problem
from app.services import DeskOf
from app.version import VERSION

ROUTER = APIRouter(include_in_schema=False)
PAGES = Path(__file__).parent.parent / "pages"
SWAGGER = PAGES / "vendor" / "swagger-ui"
FILES = {
    "style.css": (PAGES / "style.css", "text/css"),
    "docs.js": (PAGES / "docs.js", "text/javascript"),
    "swagger-ui.css": (SWAGGER / "swagger-ui.css", "text/css"),
    "swagger-ui-bundle.js": (SWAGGER / "swagger-ui-bundle.js", "text/javascript"),
    "favicon-32x32.png": (SWAGGER / "favicon-32x32.png", "image/png"),
}
POLICY = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
        "connect-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
    )
}
RECENT = 10


@ROUTER.get("/")
def start_page(request: Request, desk: DeskOf) -> HTMLResponse:
    """Show where everything is, and the latest jobs."""
    jobs = desk.store.jobs.page(limit=RECENT)
    page = Template((PAGES / "start.html").read_text())
    text = page.substitute(
        version=VERSION,
        address=escape(str(request.base_url)),
        columns=header_cells(),
        rows=job_rows(jobs, desk.catalogue),
    )
    return HTMLResponse(text, headers=POLICY)


@ROUTER.get("/docs")
def docs_page() -> HTMLResponse:
    """Show the contract in Swagger UI."""
    return HTMLResponse((PAGES / "docs.html").read_text(), headers=POLICY)


@ROUTER.get("/static/{name}")
def static_file(name: str) -> FileResponse:
    """Send one of the known files."""
    if name not in FILES:
        raise Problem("not-found", f"there is no file {name}", evidence={"known": list(FILES)})
    path, media_type = FILES[name]
    return FileResponse(path, media_type=media_type, headers={"Cache-Control": "max-age=3600"})
