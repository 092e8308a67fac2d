"""The report: it says what the document says, needs nothing from elsewhere, and trusts no text."""

import re
from html.parser import HTMLParser

import pytest

from tests.core.report.documents import (
    alternative,
    curve,
    dependence,
    diagnosed,
    finding,
    identified,
    nothing_found,
)
from veritorque.core.report.page.page import compose_page

VOID = {"meta"}
EVIL = '<script>alert("1")</script>&\'"><img src=x onerror=alert(2)>'


class Page(HTMLParser):
    """Read a page: its words, its elements, and whether every element that opens also closes."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.attributes, self.words = [], [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += [(tag, *pair) for pair in attrs]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open[-1:] != ["style"]:
            self.words.append(data)

    @property
    def text(self):
        return " ".join(" ".join(self.words).split())


DOCUMENTS = {
    "identified": identified(),
    "found": diagnosed(),
    "nothing": nothing_found(),
    "no figure": diagnosed(findings=[finding(curve=None, gain=None)]),
    "on the whole robot": diagnosed(findings=[finding(joints=[], curve=curve(direction=[0.0] * 4))]),
    "no alternatives": diagnosed(findings=[finding(ambiguous_with=[], refuted=[])]),
    "numbers that do not exist": diagnosed(
        findings=[
            finding(
                p_value=0.0,
                evidence=[{"statement": "Chance", "statistic": "log10 p", "value": None}],
                parameters=[
                    {"name": "stiffness", "joint": 1, "unit": "N m/rad", "value": 9.0,
                     "standard_deviation": None, "relative_deviation_percent": None}
                ],
                explained_residual_fraction=None,
            )
        ]
    ),
}  # fmt: skip  # a table


@pytest.fixture(params=DOCUMENTS, ids=str)
def page(request):
    return Page(compose_page(DOCUMENTS[request.param]))


def test_every_element_that_opens_also_closes(page):
    assert page.open == []


def test_a_page_asks_for_nothing_from_elsewhere_and_runs_nothing(page):
    assert not {"script", "link", "img", "iframe", "object", "embed", "form", "base"} & set(page.tags)
    for tag, name, value in page.attributes:
        assert name not in {"src", "href", "action", "style"}, (tag, name)
        assert not name.startswith("on")
        assert "url(" not in (value or "")
    assert ("meta", "http-equiv", "Content-Security-Policy") in page.attributes


def test_every_table_has_a_caption_and_says_what_its_headings_head(page):
    assert page.tags.count("caption") == page.tags.count("table")
    scopes = [value for tag, name, value in page.attributes if (tag, name) == ("th", "scope")]
    assert len(scopes) == page.tags.count("th")


def test_every_picture_can_be_told_to_who_does_not_see_it(page):
    assert page.tags.count("svg") == page.tags.count("desc")
    assert page.tags.count("title") == 1 + page.tags.count("svg")


def test_no_number_is_shown_that_does_not_exist(page):
    assert not re.search(r"\b(nan|inf|None)\b", page.text)


def test_the_first_sentence_names_what_is_wrong_and_where():
    text = Page(compose_page(diagnosed())).text
    verdict = (
        "One cause of simulation error found for bench arm: load-dependent friction, or a "
        "similar cause (joint 1)."
    )
    gain = (
        "data by 50 % on joint 1 (95 %: 40 to 60 %). The simulated position error is 50 % smaller on joint 1."
    )
    assert verdict in text
    assert gain in text
    assert text.index(verdict) < text.index(gain) < text.index("Evidence")


def test_a_name_that_is_not_sure_never_stands_alone_in_the_headline():
    text = Page(compose_page(diagnosed())).text
    assert "bench arm: load-dependent friction, or a similar cause (joint 1)." in text
    other = "Not distinguishable in this log from: torque gain error (joint 1)."
    assert text.index(other) < text.index("Findings")
    sure = Page(compose_page(diagnosed(findings=[finding(ambiguous_with=[])]))).text
    assert "bench arm: load-dependent friction (joint 1)." in sure
    assert "Not distinguishable" not in sure


def test_a_cause_that_is_no_more_likely_than_not_is_only_possible_in_the_headline():
    likely, even = finding(ambiguous_with=[]), finding(ambiguous_with=[], confidence=0.5, joints=[2])
    alone = Page(compose_page(diagnosed(findings=[even]))).text
    assert (
        "No cause of simulation error found for bench arm with more than 50 % confidence; possible: "
        "load-dependent friction (joint 2)."
    ) in alone
    both = Page(compose_page(diagnosed(findings=[likely, even]))).text
    assert (
        "One cause of simulation error found for bench arm: load-dependent friction (joint 1); possible: "
        "load-dependent friction (joint 2)."
    ) in both


def test_several_findings_are_listed_with_size_and_confidence_before_each_is_told():
    alone = finding(ambiguous_with=[])
    found = [alone, alone | {"statement": "Joint 2's gear yields", "confidence": 0.7, "joints": [2]}]
    text = Page(compose_page(diagnosed(findings=found))).text
    listed = (
        "Load-dependent friction on joint 1: 0.07 N m per N m (confidence 98 %). "
        "Joint 2's gear yields (confidence 70 %)."
    )
    assert text.index(listed) < text.index("Findings")
    assert "(confidence" not in Page(compose_page(diagnosed(findings=[alone]))).text


def test_every_joint_is_told_what_was_found_on_it_and_in_which_band_it_was_judged():
    text = Page(compose_page(diagnosed())).text
    assert "50 % 40 to 60 % Load-dependent friction 2 5.00 N" in text
    assert "Torque and error up to 9.50 Hz" in text
    assert "reduction of the error on held-out data, up to 20.0 Hz" in text


def test_what_is_left_well_above_the_noise_floor_is_not_called_nothing():
    left = diagnosed()["diagnosis"]["unexplained"]
    above = left | {"rms_residual": [0.2, 0.2], "noise_floor": [0.1, 0.19]}
    text = Page(compose_page(diagnosed(unexplained=above))).text
    assert "On joint 1 the residual is well above the noise floor" in text
    assert "well above" not in Page(compose_page(diagnosed())).text


def test_a_joint_that_hardly_moved_is_not_said_to_be_without_fault():
    left = diagnosed()["diagnosis"]["unexplained"]
    left |= {"predictable_residual_fraction": [0.0, None], "interval_95": [[0.0, 0.0], [None, None]]}
    text = Page(compose_page(diagnosed(unexplained=left | {"rms_residual": [0.1, None]}))).text
    assert "cannot predict the residual of any other joint" in text
    assert "No statement is possible on joint 2: there is hardly any motion." in text


def test_one_cause_on_several_joints_is_one_thing():
    alone = finding(ambiguous_with=[])
    found = [alone, alone | {"joints": [3]}, alone | {"title": "Joint elasticity", "joints": [2]}]
    text = Page(compose_page(diagnosed(findings=found))).text
    titles = "load-dependent friction (joints 1 and 3) and joint elasticity (joint 2)."
    assert f"Two causes of simulation error found for bench arm: {titles}" in text


def test_a_joint_whose_interval_holds_zero_is_not_said_to_have_gained():
    text = Page(compose_page(diagnosed())).text
    assert "on joint 2 (95 %" not in text


def test_a_finding_is_told_with_its_size_its_reasons_and_its_alternatives():
    text = Page(compose_page(diagnosed())).text
    assert "Load-dependent friction on joint 1: 0.07 N m per N m." in text
    assert "load coefficient 0.0700 ± 0.0020 2.9 %" in text
    assert "Log-likelihood ratio statistic 91.5." in text
    undecided, refuted = text.index("Not distinguishable from"), text.index("Rejected")
    assert undecided < text.index("the reason about torque_gain") < refuted
    assert refuted < text.index("the reason about torque_ripple")
    assert "run both directions" in text


def test_a_finding_is_told_with_its_repair_where_the_document_has_one():
    one = {"cause": "friction_load_dependent", "joints": [1], "mends": "log", "what": "It is halved"}
    text = Page(compose_page(diagnosed(repairs=[one]))).text
    assert "0.07 N m per N m. Correction: It is halved." in text
    assert "Correction:" not in Page(compose_page(diagnosed())).text


def test_both_directions_of_motion_are_drawn_apart_where_the_document_has_them_apart():
    apart, together = (
        Page(compose_page(diagnosed(findings=[finding(curve=curve(direction=one))])))
        for one in ([-1.0, -1.0, 1.0, 1.0], [0.0] * 4)
    )
    kinds = [
        {value for tag, name, value in one.attributes if (tag, name) == ("circle", "class")}
        for one in (apart, together)
    ]
    assert kinds == [{"dot backward", "dot forward"}, {"dot both"}]


def test_the_curve_shows_what_the_finding_takes_away_so_that_explained_dots_lie_on_it():
    shown = curve(centre=[0.0, 1.0], before=[1.0, 3.0], after=[0.0, 0.0], standard_error=[0.1, 0.1])
    page = Page(compose_page(diagnosed(findings=[finding(curve=shown | {"direction": [0.0, 0.0]})])))
    (line,) = [
        points
        for (tag, name, points), (_, _, kind) in zip(page.attributes, page.attributes[1:], strict=False)
        if (tag, name, kind) == ("polyline", "points", "line model")
    ]
    across = [value for tag, name, value in page.attributes if (tag, name) == ("circle", "cx")][:2]
    down = [value for tag, name, value in page.attributes if (tag, name) == ("circle", "cy")][:2]
    dots = [(float(x), float(y)) for x, y in zip(across, down, strict=True)]
    assert [tuple(float(one) for one in point.split(",")) for point in line.split()] == dots


def test_torque_of_a_sliding_joint_is_a_force():
    text = Page(compose_page(identified())).text
    assert "1 10.0 N m" in text
    assert "2 5.00 N 0.175 N " in text
    assert "2 5.00 N m" not in text


def test_motion_is_compared_at_every_horizon_in_thousandths():
    text = Page(compose_page(diagnosed())).text
    assert "before, 50 ms after, 50 ms before, 200 ms after, 200 ms improvement 95 %" in text
    assert "1 1.00 mrad 0.500 mrad 4.00 mrad 2.00 mrad 50 % 45 to 55 %" in text
    assert "from 60 measured states" in text


def test_motion_that_was_not_compared_is_said_with_its_reason():
    simulation = {"before": {}, "after": {}, "note": "a finding remembers the motion"}
    text = Page(compose_page(diagnosed(simulation=simulation))).text
    assert "The motion of the two models was not compared: a finding remembers the motion." in text


def test_what_the_motion_was_not_free_to_decide_is_said_below_its_table():
    simulation = diagnosed()["diagnosis"]["simulation"] | {"note": "time_delay is taken out"}
    text = Page(compose_page(diagnosed(simulation=simulation))).text
    assert "simulated and measured position. Extended model: time_delay is taken out." in text


def test_a_gain_is_marked_as_real_only_where_its_interval_leaves_zero_out():
    page = compose_page(diagnosed())
    assert page.count('<span class="better">50 %</span>') == 2  # joint 1 in torque and in motion
    assert page.count("<span>50 %</span>") == 1  # joint 2 in motion


def test_a_correction_without_significant_gain_is_reported_without_gain():
    weak = diagnosed()["diagnosis"]["gain"][1:]
    text = Page(compose_page(diagnosed(gain=weak))).text
    assert "(up to 9.50 Hz), the correction gives no significant improvement on held-out data." in text
    assert "The correction reduces" not in text


def test_what_only_the_raw_samples_show_is_reported_as_not_corrected():
    raw = {"statement": "Raw", "statistic": "raw check", "value": 6.3}
    found = finding(gain=None, curve=None, evidence=[raw], ambiguous_with=[], refuted=[])
    text = Page(compose_page(diagnosed(findings=[found], gain=[]))).text
    assert "show it before any model is fitted; test statistic 6.30." in text
    assert "It has to be corrected where the log is recorded" in text
    assert "No other known cause explains" not in text


def test_against_a_reference_the_report_says_what_differs_from_it():
    compared = {"name": "job-7", "left_open": [], "worse_than_nothing": [], "base_parameters": []}
    sure = finding(ambiguous_with=[])
    text = Page(compose_page(diagnosed(findings=[sure], reference=compared))).text
    grows = "load-dependent friction (joint 1)."
    assert f"One difference between bench arm and the result of job-7: {grows}" in text
    assert "The parameters of the result of job-7 served as a prior" in text
    same = Page(compose_page(diagnosed(verdict="nothing_found", findings=[], reference=compared))).text
    assert "No difference found between bench arm and the result of job-7." in same
    prior = Page(compose_page(diagnosed(findings=[sure], reference=compared | {"name": "prior"}))).text
    assert "One difference between bench arm and its own description" in prior


def test_nothing_found_is_said_as_plainly_as_a_cause():
    text = Page(compose_page(nothing_found())).text
    assert "No cause of simulation error found for bench arm." in text
    assert "Findings" not in text
    assert "No extension of the model would give a significant improvement." in text
    missing = "The reason about encoder_offset: Encoder zero error, joint 1 . Separating experiment:"
    assert missing in text
    assert "1 10.0 N m 0.200 N m 2.0 % 2 5.00 N" in text  # one column of errors, as nothing was cured


def test_structure_without_a_cause_is_said_with_its_joint_and_place():
    place = {"coordinate": "velocity", "unit": "rad/s", "low": 0.1, "high": 0.4, "rms": 0.3}
    left = diagnosed()["diagnosis"]["unexplained"] | {"joints": [1], "places": [[place], []]}
    alone = Page(compose_page(diagnosed(verdict="unexplained", findings=[], unexplained=left))).text
    assert "in the torque of joint 1: no known cause explains it" in alone
    assert "velocity of joint 1 from 0.100 to 0.400 rad/s" in alone
    beside = Page(compose_page(diagnosed(verdict="unexplained", unexplained=left))).text
    assert "One cause of simulation error found" in beside
    assert "Part of the residual on joint 1 has no known cause." in beside


def test_what_is_left_is_drawn_over_the_coordinate_that_it_follows_most_clearly():
    left = diagnosed()["diagnosis"]["unexplained"] | {"joints": [2]}
    atlas = [
        dependence("time", 2, 1e-3),
        dependence("velocity", 2, 1e-9),
        dependence("position", 1, 1e-12),
        dependence("temperature", 2, None),
    ]
    page = Page(compose_page(diagnosed(findings=[], verdict="unexplained", unexplained=left, atlas=atlas)))
    assert "joint 2: residual, over the velocity of joint 2" in page.text
    assert page.tags.count("circle") == 3
    quiet = Page(compose_page(diagnosed(findings=[], atlas=atlas)))
    assert "circle" not in quiet.tags


def test_the_page_tells_data_defects_doubts_and_origin():
    text = Page(compose_page(identified())).text
    data = ("swing.csv", "2400", "outliers, joint 2 (log 1) : 3 samples", "The motion does not excite MX2.")
    origin = ("abc123", '{"essential": true}', "Veritorque 0.1.0")
    for told in (*data, *origin):
        assert told in text, told


def test_an_identification_is_told_with_its_error_on_held_out_data_and_whether_the_robot_is_consistent():
    text = Page(compose_page(identified())).text
    assert "bench arm: 12 base parameters identified, physically consistent; torque error 2.8 %" in text
    assert "on held-out data" in text
    assert "ordinary least squares: inconsistent" in text
    seen = Page(compose_page(identified(validation=[], validation_total_percent=None))).text
    assert "torque error 2.2 % on fitted data" in seen


def test_percentages_that_say_nothing_are_told_by_their_bounds():
    tiny = Page(compose_page(identified(validation_total_percent=4e-6))).text
    assert "torque error < 0.1 % on held-out data" in tiny
    huge = Page(compose_page(identified(validation_total_percent=2.07e9))).text
    assert "torque error > 1000 % on held-out data" in huge


@pytest.mark.parametrize(
    ("kinds", "unit"),
    [
        (["revolute", "revolute"], "0.0700 kg m²."),
        (["prismatic", "prismatic"], "0.0700 kg."),
        (["revolute", "prismatic"], "0.0700 in SI units, with entries in kg m², kg m and kg."),
    ],
)
def test_eigenvalues_are_told_with_their_unit_or_that_they_have_none(kinds, unit):
    robot = {"name": "bench arm", "joints": [{"type": kind} for kind in kinds]}
    text = Page(compose_page(identified(robot=robot))).text
    assert f"mass matrix in 10000 configurations of the workspace: {unit}" in text
    assert "pseudo-inertia: 0.00100 in SI units, with entries in kg m², kg m and kg" in text


def test_the_parameters_of_a_diagnosis_are_those_of_the_extended_model():
    text = Page(compose_page(diagnosed())).text
    assert "load_coefficient1* 0.500 ± 0.010 2.0 % 0.600 added ZZR1*" in text


def test_no_text_of_a_user_becomes_markup():
    document = diagnosed(
        findings=[finding(title=EVIL, statement=EVIL, refuted=[alternative(EVIL, EVIL, EVIL)])]
    )
    document["robot"] = {"name": EVIL, "joints": []}
    document["logs"] = [{"name": EVIL}]
    document["doubts"] = [EVIL]
    document["provenance"] = {"version": EVIL, "log_sha256": [EVIL], "options": {EVIL: EVIL}}
    page = Page(compose_page(document))
    assert page.open == []
    assert not {"script", "img"} & set(page.tags)
    assert EVIL in page.text
