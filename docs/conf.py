"""Build these pages as a site: `make docs`. They are plain Markdown and read as well where they lie.

`NAVIGATION` is the whole order of the site, in the four kinds of documents (tutorial, how-to, reference,
explanation): a new page is one more name in it. Nothing on the site comes from elsewhere: no fonts, no
scripts of other hosts; formulas become MathML, which browsers draw themselves; search runs in the page.
"""

import re
from pathlib import Path

from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.util.docutils import nodes
from sphinx.writers.html5 import HTML5Translator

NAVIGATION = {
    "Start": ["tutorial", "questions"],
    "How to": [
        "pages",
        "terminal",
        "client",
        "mdh",
        "robots",
        "logs",
        "currents",
        "exciting",
        "identification",
        "conflicts",
        "audit",
        "diagnosis",
        "payload",
        "export",
        "http",
        "offline",
        "operating",
    ],
    "Reference": ["api", "options", "problems", "formats", "terms", "causes"],
    "Explanation": [
        "method",
        "estimators",
        "feasibility",
        "precision",
        "accuracy",
        "performance",
        "limits",
        "decisions",
    ],
}

_HERE = Path(__file__).parent

project = "Veritorque"
author = "The Veritorque authors"
html_title = project
language = "en"
extensions = ["myst_parser"]
smartquotes = False
highlight_language = "text"
pygments_style = "friendly"
pygments_dark_style = "github-dark"

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
nitpicky = True

html_theme = "furo"
html_show_copyright = False
html_show_sphinx = False
html_copy_source = False
html_math_renderer = "mathml"
html_theme_options = {
    "light_css_variables": {"font-stack": "system-ui, sans-serif"},
    "dark_css_variables": {"font-stack": "system-ui, sans-serif"},
}


_OUTSIDE = re.compile(r"\[([^\]]+)\]\(\.\./([^)#]+)[^)]*\)")
"""A link to a file of the project that is no page of the site, which names it instead."""


def _prepare(_: Sphinx, page: str, text: list[str]) -> None:
    """Append the order of the site to the front page, where a reader of the plain file need not see it."""
    text[0] = _OUTSIDE.sub(r"\1 (`\2`)", text[0])
    if page == "index":
        text[0] += "".join(_branch(kind, pages) for kind, pages in NAVIGATION.items())


def _branch(kind: str, pages: list[str]) -> str:
    """Write one kind of documents."""
    return "\n".join(["", "```{toctree}", f":caption: {kind}", ":hidden:", "", *pages, "```", ""])


def _inline(writer: HTML5Translator, node: nodes.math) -> None:
    writer.body.append(convert(node.astext()))
    raise nodes.SkipNode


def _displayed(writer: HTML5Translator, node: nodes.math_block) -> None:
    writer.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>')
    raise nodes.SkipNode


def setup(app: Sphinx) -> None:
    """Hand the navigation and the formulas to Sphinx."""
    app.connect("source-read", _prepare)
    app.add_html_math_renderer("mathml", (_inline, None), (_displayed, None))
