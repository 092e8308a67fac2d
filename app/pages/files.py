"""Know the files that the pages are made of: no other file is ever given out.

Pages are plain HTML and small ES modules, served as they were written; there is nothing to build. Files are
known by the hash of their bytes, so that a browser asks again and downloads only what changed.
"""

import gzip
import hashlib
import json
from dataclasses import dataclass
from functools import cache, cached_property
from html import escape
from pathlib import Path
from string import Template
from typing import Final

from ...core.estimate.methods.registry import ESTIMATORS
from ...core.joint_model.names import ESTIMATORS as JOINT_ESTIMATORS
from ...core.joint_model.names import ORDER_NAMES
from ...core.log.channels import CHANNELS, REFERENCE_WORDS
from ..kinds.registry import KINDS
from ..version import VERSION

PAGES: Final = Path(__file__).parent
MEDIA_TYPES: Final = {
    ".css": "text/css",
    ".csv": "text/csv",
    ".js": "text/javascript",
    ".png": "image/png",
    ".svg": "image/svg+xml",
}
BUNDLES: Final = (
    "swagger-ui/swagger-ui.css",
    "swagger-ui/swagger-ui-bundle.js",
    "swagger-ui/favicon-32x32.png",
    "uplot/uPlot.esm.js",
    "uplot/uPlot.min.css",
)
_POLICY: Final = (
    "default-src 'none'; script-src 'self'; style-src 'self'{}; img-src 'self' data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
)
STRICT: Final = {"Content-Security-Policy": _POLICY.format("")}
PLAIN: Final = {"Content-Security-Policy": _POLICY.format(" 'unsafe-inline'")}
"""Swagger UI writes styles into its elements."""


@dataclass(frozen=True)
class PageFile:
    """Name a file that is given out."""

    path: Path

    @property
    def media_type(self) -> str:
        """Give the media type, by the file's suffix."""
        return MEDIA_TYPES[self.path.suffix]

    @cached_property
    def sha256(self) -> str:
        """Give the hash of the file's bytes."""
        return hashlib.sha256(self.content()).hexdigest()

    @cached_property
    def packed(self) -> bytes:
        """Give the file's bytes for browsers that unpack them."""
        return gzip.compress(self.content(), mtime=0)

    def content(self) -> bytes:
        """Read the file."""
        return self.path.read_bytes()


@cache
def shell(name: str) -> str:
    """Write a page: the frame that all of them share, around what is its own.

    Examples
    --------
    >>> "<main" in shell("start")
    True
    """
    own = (PAGES / f"{name}.html").read_text(encoding="utf-8")
    if own.startswith("<!doctype"):
        return own
    title, _, content = own.partition("\n")
    frame = Template((PAGES / "frame.html").read_text(encoding="utf-8"))
    return frame.substitute(title=title, name=name, content=content, version=VERSION, **_tables())


def _tables() -> dict[str, str]:
    """Write the registries that forms offer as JSON for attributes: channels, kinds of job, estimators."""
    kinds = [
        {
            "name": kind.name,
            "title": kind.words.title,
            "hint": kind.words.hint,
            "takes_logs": kind.takes_logs,
            "takes_reference": kind.takes_reference,
            "compares": kind.compares,
            "asks_joint": kind.asks_joint,
        }
        for kind in KINDS.values()
    ]
    estimators = [{"name": method.name, "title": method.title} for method in ESTIMATORS.values()]
    joint = {
        "estimators": [{"name": name, "title": title} for name, title in JOINT_ESTIMATORS.items()],
        "orders": [{"name": name, "title": f"{name} joint"} for name in reversed(ORDER_NAMES)],
    }
    analyses = {"kinds": kinds, "estimators": estimators, "joint": joint}
    tables = {"channels": _channels(), "analyses": analyses}
    return {name: escape(json.dumps(table)) for name, table in tables.items()}


def _channels() -> dict[str, object]:
    table = {
        channel.name: {
            "words": channel.words,
            "unit": channel.unit,
            "units": [unit.name for unit in channel.quantity.units],
            "reference_to": channel.reference_to,
        }
        for channel in CHANNELS.values()
    }
    return {"channels": table, "reference_words": sorted(REFERENCE_WORDS)}


def _page_files() -> dict[str, PageFile]:
    static = PAGES / "static"
    own = {path.relative_to(static).as_posix(): path for path in sorted(static.rglob("*.*"))}
    others = [*sorted((PAGES / "example").iterdir()), *(PAGES / "vendor" / bundle for bundle in BUNDLES)]
    return {name: PageFile(path) for name, path in (own | {path.name: path for path in others}).items()}


STATIC: Final = _page_files()
