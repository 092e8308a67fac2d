"""The site builds without a warning, lists every page, works from the disk, and asks nobody for anything."""

import re
import subprocess
import sys

import pytest

from tests.docs.blocks import ROOT

LOADED = re.compile(r"<(?:script|img|iframe|link)\b[^>]*?(?:src|href)=\"(?:https?:)?//[^\"]*\"")


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The whole site, built as `make docs` builds it."""
    folder = tmp_path_factory.mktemp("site")
    strict = ("--fail-on-warning", "--keep-going", "--nitpicky", "--quiet")
    command = [
        sys.executable,
        "-m",
        "sphinx",
        *strict,
        "-d",
        str(folder / "cache"),
        "docs",
        str(folder / "html"),
    ]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder / "html"


def test_every_page_is_on_the_site_and_in_its_navigation(site):
    front = (site / "index.html").read_text(encoding="utf-8")
    for page in (ROOT / "docs").glob("*.md"):
        assert (site / f"{page.stem}.html").exists()
        assert page.stem == "index" or f'href="{page.stem}.html"' in front


def test_nothing_is_loaded_from_elsewhere(site):
    for page in site.rglob("*.html"):
        assert LOADED.findall(page.read_text(encoding="utf-8")) == [], page.name
    for style in site.rglob("*.css"):
        assert not re.search(r"url\([\"']?(?:https?:)?//|@import", style.read_text(encoding="utf-8")), (
            style.name
        )


def test_formulas_are_drawn_by_the_browser_alone(site):
    method = (site / "method.html").read_text(encoding="utf-8")
    assert method.count("<math") > 100
    assert "$$" not in re.sub(r"<pre>.*?</pre>", "", method, flags=re.DOTALL)


def test_search_works_from_the_disk_and_finds_what_people_ask_for(site):
    index = (site / "searchindex.js").read_text(encoding="utf-8")
    assert index.startswith("Search.setIndex(")  # a script, which a page may load from a folder
    words = ("overfit", "payload", "craig", "negat", "inertia", "cutoff_hz", "urdf")
    assert all(word in index for word in words)


def test_a_request_to_elsewhere_would_be_noticed():
    assert LOADED.search('<script defer src="https://cdn.example/a.js"></script>')
    assert LOADED.search('<link rel="stylesheet" href="//fonts.example/a.css">')
    assert not LOADED.search('<a href="https://example.org/">')
