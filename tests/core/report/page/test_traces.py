"""Motion and torque over time, error bars, origin: what the page shows beside what it says."""

import re

from hypothesis import given
from hypothesis import strategies as st

from tests.core.report.documents import diagnosed, identified
from tests.core.report.page.test_page import Page
from tests.core.report.page.worlds import traces
from veritorque.core.report.page.page import compose_page
from veritorque.core.report.page.running import Origin, css_string
from veritorque.core.report.page.whisker import whisker
from veritorque.core.report.page.words import MINUS

ORIGIN = Origin("job-1", "2026-01-31T12:34:56.000+00:00")


def lines(page, kind):
    marked = zip(page.attributes, page.attributes[1:], strict=False)
    return [points for (_, _, points), (_, _, word) in marked if word == f"line trace {kind}"]


def test_every_joint_is_drawn_with_what_was_measured_filtered_estimated_and_left():
    page = Page(compose_page(identified(), traces=traces(2)))
    assert page.open == []
    for kind in ("measured", "filtered", "estimated"):
        assert len(lines(page, kind)) == 4  # two joints, each broken at a gap
    assert len(lines(page, "residual")) == 2
    assert "estimated by the identified model" in page.text
    assert "Measured and predicted torque" not in Page(compose_page(identified())).text


def test_after_a_diagnosis_the_extended_model_is_drawn():
    text = Page(compose_page(diagnosed(), traces=traces(2, extended=True))).text
    assert "estimated by the extended model" in text


def test_every_figure_tells_in_words_what_it_shows_and_in_which_unit():
    page = Page(compose_page(identified(), traces=traces(2)))
    assert page.tags.count("desc") == page.tags.count("svg")
    assert f"Joint 2 from {MINUS}2.00 to 2.00 rad." in page.text
    assert "Torque of joint 2 over time" in page.text


def test_joints_share_a_picture_of_their_motion_as_far_as_there_are_colours():
    page = Page(compose_page(identified(), traces=traces(10)))
    assert len(lines(page, "j1")) == 6  # two pictures of position with a gap, two of speed
    assert lines(page, "j9") == []


def test_each_of_several_logs_is_named():
    both = [*traces(1), *traces(1, log=2)]
    assert "Log 1: swing.csv" in Page(compose_page(identified(), traces=both)).text
    assert "Log 1:" not in Page(compose_page(identified(), traces=traces(1))).text


def test_a_page_with_traces_stays_small_enough_to_be_mailed():
    assert len(compose_page(identified(), traces=traces(7))) < 400_000


def test_the_page_says_of_which_job_it_is_and_from_when_on_the_screen_and_on_every_sheet():
    text = compose_page(identified(), origin=ORIGIN)
    assert "job-1" in Page(text).text
    assert "2026-01-31 12:34 UTC" in Page(text).text
    (below,) = re.findall(r"@bottom-left \{ content: '([^']*)'", text)
    assert "job\\2d 1" in below
    assert "counter(page)" in text


@given(st.text(max_size=60))
def test_no_name_can_leave_the_style_sheet(name):
    written = css_string(name)
    assert re.fullmatch(r"'[A-Za-z0-9\\ ]*'", written)
    codes = re.findall(r"\\([0-9a-f]+) |([A-Za-z0-9])", written)
    assert "".join(chr(int(code, 16)) if code else letter for code, letter in codes) == name


def test_error_bars_reach_from_end_to_end_of_both_intervals_beside_zero():
    row = {"name": "ZZ1", "unit": "kg m2", "value": 2.0, "interval_95": [1.0, 3.0]}
    drawn = whisker(row | {"bootstrap_interval_95": [0.5, 4.0]})
    ends = {
        kind: (float(a), float(b))
        for a, b, kind in re.findall(
            r'x1="([\d.]+)" x2="([\d.]+)" y1="8.0" y2="8.0" class="bar (\w+)"', drawn
        )
    }
    # Zero lies at 4 and 4.0 at 116 of 120: 28 a unit.
    assert ends == {"thin": (18.0, 116.0), "thick": (32.0, 88.0)}
    assert 'cx="60.0"' in drawn


def test_a_parameter_without_an_interval_has_no_error_bars():
    row = {"name": "ZZ1", "unit": "kg m2", "value": 2.0}
    assert whisker(row) is None
    assert whisker(row | {"interval_95": [None, None]}) is None


def test_every_log_is_named_with_its_hash_and_what_the_motion_is_worth():
    precision = {"equations": 900, "left_out_percent": 2.0, "noise": [0.1, 0.2], "memory_factor": [1.5, 2.5]}
    text = Page(compose_page(identified(precision=precision, condition_number_scaled=8.0))).text
    assert "swing.csv SHA-256 abc123" in text
    assert "8.00 with columns scaled to unit norm" in text
    assert "2 0.200 N 2.50" in text
