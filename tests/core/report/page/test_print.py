"""The report on paper and on a phone, as a browser lays it out: nothing is cut, nothing sticks out."""

import json
import re
import shutil
import subprocess
from html import escape, unescape

import pytest

from tests.core.report.documents import diagnosed, identified, parameter
from tests.core.report.page.worlds import traces
from veritorque.core.report.page.page import compose_page
from veritorque.core.report.page.running import Origin

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
pytestmark = pytest.mark.skipif(BROWSER is None, reason="SKIPPED FOR WANT OF A BROWSER: no chromium here")

PAPER_WIDE, PAPER_HIGH = 680, 996
"""What A4 leaves between its margins, in pixels of 1/96 inch."""
PHONE_WIDE = 360
SABOTAGE = (
    '<p style="width:900px">wide</p><svg viewBox="0 0 90 9" width="90"><text x="80">cut</text></svg>'
    '<figure style="height:1200px">high</figure>'
)
MEASURE = """
addEventListener('load', () => {
  const found = [...document.querySelectorAll('iframe')].map((frame) => {
    const page = frame.contentDocument, wide = page.documentElement.clientWidth;
    const box = (one) => one.getBoundingClientRect();
    const named = (one) => `${one.tagName} ${one.textContent.trim().slice(0, 40)}`;
    const every = (what) => [...page.querySelectorAll(what)];
    return {
      name: frame.name,
      sideways: page.documentElement.scrollWidth - wide,
      out: every('table, figure, svg, p, code, li, dd').filter((one) => box(one).right > wide + 1).map(named),
      cut: every('svg text').filter((one) => {
        const inner = box(one), outer = box(one.ownerSVGElement);
        const out = [outer.left - inner.left, inner.right - outer.right, inner.bottom - outer.bottom];
        return Math.max(...out) > 1;
      }).map(named),
      high: Math.max(...every('figure, .wide:not(.long), .key, tr').map((one) => box(one).height)),
    };
  });
  document.body.innerHTML = '';
  document.body.append(Object.assign(document.createElement('pre'), {textContent: JSON.stringify(found)}));
});
"""


def documents():
    rows = [
        parameter(name=f"ZZR{place}", grouping=" + ".join(f"0.0320 M{k}" for k in range(9)))
        for place in range(71)
    ]
    origin = Origin("job-0123456789abcdef0123", "2026-01-31T12:34:56.000+00:00")
    return {
        "identification": compose_page(identified(base_parameters=rows), origin=origin, traces=traces(7)),
        "diagnosis": compose_page(
            diagnosed(base_parameters=rows), origin=origin, traces=traces(7, extended=True)
        ),
    }


def frame(name, page, wide):
    style = f"width:{wide}px;height:900px;border:0"
    return f'<iframe name="{name}" style="{style}" srcdoc="{escape(page)}"></iframe>'


def browser(*arguments):
    flags = (
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-dev-shm-usage",
        "--virtual-time-budget=3000",
    )
    done = subprocess.run(
        [BROWSER, *flags, *map(str, arguments)], capture_output=True, timeout=120, check=True
    )
    return done.stdout.decode()


@pytest.fixture(scope="module")
def laid_out(tmp_path_factory):
    """Both pages as paper and as a phone see them: what sticks out, what is cut, how high the highest is."""
    frames = [frame("sabotage", SABOTAGE, PAPER_WIDE)]
    for name, page in documents().items():
        on_paper = page.replace("@media print", "@media all")
        for kind, text, wide in (("paper", on_paper, PAPER_WIDE), ("phone", page, PHONE_WIDE)):
            frames.append(frame(f"{name} on {kind}", text, wide))
    file = tmp_path_factory.mktemp("browser") / "frames.html"
    file.write_text(f"<!doctype html><body><script>{MEASURE}</script>{''.join(frames)}", encoding="utf-8")
    (told,) = re.findall(r"<pre>(.*?)</pre>", browser("--dump-dom", file.as_uri()), re.DOTALL)
    return {one["name"]: one for one in json.loads(unescape(told))}


def test_what_is_cut_or_sticks_out_is_noticed(laid_out):
    seen = laid_out["sabotage"]
    assert seen["sideways"] > 0
    assert (seen["out"], seen["cut"]) == (["P wide"], ["text cut"])
    assert seen["high"] > PAPER_HIGH


@pytest.mark.parametrize("name", ["identification", "diagnosis"])
@pytest.mark.parametrize("kind", ["paper", "phone"])
def test_nothing_of_a_page_is_cut_or_sticks_out(laid_out, name, kind):
    seen = laid_out[f"{name} on {kind}"]
    assert seen["sideways"] <= 0
    if kind == "paper":  # on a phone wide tables are pushed sideways by themselves
        assert seen["out"] == []
    assert seen["cut"] == []


@pytest.mark.parametrize("name", ["identification", "diagnosis"])
def test_whatever_is_kept_on_one_sheet_fits_on_one(laid_out, name):
    assert laid_out[f"{name} on paper"]["high"] < PAPER_HIGH


def test_a_page_prints_on_numbered_sheets_of_a4(tmp_path):
    page, paper = tmp_path / "report.html", tmp_path / "report.pdf"
    page.write_text(documents()["identification"], encoding="utf-8")
    browser("--no-pdf-header-footer", f"--print-to-pdf={paper}", page.as_uri())
    sheets = re.findall(rb"/Type\s*/Page\b", paper.read_bytes())
    assert 4 <= len(sheets) <= 8  # motion, seven joints, 71 parameters with long groupings
    (wide, high) = re.search(rb"/MediaBox\s*\[\s*0 0 ([\d.]+) ([\d.]+)", paper.read_bytes()).groups()
    assert (float(wide), float(high)) == pytest.approx((595.0, 842.0), abs=1.0)  # points
