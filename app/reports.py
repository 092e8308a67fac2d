"""Answer with the report of a result: one page that opens offline and can do nothing but be read."""

import json

from fastapi.responses import HTMLResponse

from core.report.page.page import POLICY, compose_page

FRAMED = "; frame-ancestors 'none'; sandbox"
"""What only a header may say: the page is shown nowhere else, and runs nothing."""


def report_response(result: bytes) -> HTMLResponse:
    """Draw the report of a stored result document."""
    headers = {"Content-Security-Policy": POLICY + FRAMED}
    return HTMLResponse(compose_page(json.loads(result)), headers=headers)
