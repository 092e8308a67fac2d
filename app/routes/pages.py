"""Serve the pages that people read, from files of our own and without a request to anywhere else."""

from html import escape
from pathlib import Path
from string import Template

from fastapi import APIRouter, Request
from fastapi.responses import FileResponse, HTMLResponse

from app.problems import Problem
from app.services import ServicesOf
from app.store.records import JobRecord
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
def start_page(request: Request, services: ServicesOf) -> HTMLResponse:
    """Show where everything is, and the latest jobs."""
    jobs, total = services.store.jobs.page(limit=RECENT, offset=0)
    page = Template((PAGES / "start.html").read_text())
    rows = "".join(_row(job) for job in jobs)
    empty = '<tr><td colspan="5">None yet.</td></tr>'
    address = escape(str(request.base_url))
    text = page.substitute(version=VERSION, address=address, rows=rows or empty, total=total)
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


def _row(job: JobRecord) -> str:
    path = escape(f"/v1/jobs/{job.id}")
    result = f'<a href="{path}/results">result</a>' if job.state == "successful" else ""
    progress = f"{escape(job.stage)} {job.fraction:.0%}" if job.state == "running" else ""
    cells = (
        f'<a href="{path}">{escape(job.id)}</a>',
        escape(job.request.robot),
        f'<span class="state {escape(job.state)}">{escape(job.state)}</span> {progress}',
        escape(job.created_at[:19].replace("T", " ")),
        result,
    )
    return "<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"
