"""The score itself, by hand-made diagnoses."""

from dataclasses import replace

import pytest

from tests.hidden.plan import Order, orders
from tests.hidden.score import Rate, brier, confusion, rate, reliability, score
from tests.hidden.tables import tables
from tests.plant.cases import Truth
from tests.plant.effects.effect import Hidden
from tests.plant.effects.registry import EFFECTS
from tests.plant.sensors import NOISES

STRIBECK = Truth(
    cause="friction_stribeck",
    joints=(2,),
    parameters=(Hidden("excess_torque", 2, "N m", 1.0), Hidden("stribeck_velocity", 2, "rad/s", 0.1)),
    strength=1.0,
    noncentrality=100.0,
    nameable=True,
    local=True,
)
DELAY = replace(
    STRIBECK, cause="time_delay", joints=(1, 2, 3), parameters=(Hidden("delay", 1, "s", 0.004),), local=False
)


def finding(cause, joints, *, confidence=0.95, alternatives=(), elsewhere=(), parameters=()):
    named = [
        {"name": name, "joint": joint, "unit": "", "value": value, "standard_deviation": deviation}
        for name, joint, value, deviation in parameters
    ]
    return {
        "cause": cause,
        "joints": list(joints),
        "confidence": confidence,
        "parameters": named,
        "ambiguous_with": [
            {
                "cause": alternative,
                "joints": list(elsewhere or joints),
                "why": "",
                "separating_experiment": "",
            }
            for alternative in alternatives
        ],
    }


def diagnosis(*findings, verdict=None):
    return {
        "verdict": verdict or ("causes_found" if findings else "nothing_found"),
        "findings": list(findings),
    }


def scored(given, *truth, kind="single"):
    return score(given, truth, kind=kind, noise="white", seed=1)


def test_the_right_cause_on_its_joint_is_exact():
    (answer,) = scored(diagnosis(finding("friction_stribeck", [2])), STRIBECK).answers
    assert (answer.named, answer.exact, answer.given) == (True, True, "friction_stribeck")


def test_the_right_cause_on_another_joint_is_missed_and_extra():
    one = scored(diagnosis(finding("friction_stribeck", [1])), STRIBECK)
    assert not one.answers[0].named
    assert one.extra == ("friction_stribeck",)
    assert one.confidences == ((0.95, False),)


def test_a_declared_alternative_names_a_cause_but_not_exactly():
    found = finding("friction_presliding", [2], alternatives=["friction_stribeck"])
    one = scored(diagnosis(found), STRIBECK)
    assert (one.answers[0].named, one.answers[0].exact) == (True, False)
    assert one.answers[0].given == "friction_presliding"
    assert one.extra == ()


def test_an_alternative_names_a_cause_where_it_acts_and_not_where_the_finding_does():
    found = finding("friction_stribeck", [1], alternatives=["friction_stribeck"], elsewhere=[2])
    one = scored(diagnosis(found), STRIBECK)
    assert (one.answers[0].named, one.answers[0].exact, one.answers[0].sizes) == (True, False, ())
    assert one.extra == ()
    found = finding("friction_presliding", [2], alternatives=["friction_stribeck"], elsewhere=[1])
    assert not scored(diagnosis(found), STRIBECK).answers[0].named


def test_a_cause_of_the_whole_log_need_not_name_its_joints():
    assert scored(diagnosis(finding("time_delay", [])), DELAY).answers[0].exact


def test_silence_is_a_miss_and_what_was_said_instead_is_kept():
    assert scored(diagnosis(), STRIBECK).answers[0].given == "nothing_found"
    instead = diagnosis(finding("torque_ripple", [2], confidence=0.6), finding("torque_gain", [1]))
    assert scored(instead, STRIBECK).answers[0].given == "torque_ripple"


def test_a_size_counts_as_right_within_its_95_percent_interval():
    numbers = [("excess_torque", 2, 1.1, 0.1), ("stribeck_velocity", 2, 0.2, 0.01), ("another", 2, 1.0, 1.0)]
    (answer,) = scored(diagnosis(finding("friction_stribeck", [2], parameters=numbers)), STRIBECK).answers
    assert answer.sizes == (True, False)


def test_a_phase_is_judged_on_the_circle():
    phase = Hidden("phase", 1, "rad", 3.1)
    truth = replace(STRIBECK, cause="torque_ripple", joints=(1,), parameters=(phase,))
    found = finding("torque_ripple", [1], parameters=[("phase", 1, -3.15, 0.05)])
    assert scored(diagnosis(found), truth).answers[0].sizes == (True,)


def test_a_span_of_time_is_compared_with_the_one_that_it_overlaps():
    ends = (("start_1", 2.0), ("end_1", 2.5), ("start_2", 9.0), ("end_2", 9.6))
    hidden = tuple(Hidden(name, 1, "s", value) for name, value in ends)
    truth = replace(STRIBECK, cause="external_contact", joints=(1, 2), parameters=hidden, local=False)
    found = finding(
        "external_contact", [2], parameters=[("start_1", None, 9.02, 0.05), ("end_1", None, 9.9, 0.05)]
    )
    assert scored(diagnosis(found), truth).answers[0].sizes == (True, False)


def test_a_size_without_a_deviation_is_not_judged():
    found = finding("time_delay", [], parameters=[("delay", None, 0.004, None)])
    assert scored(diagnosis(found), DELAY).answers[0].sizes == ()


def test_two_causes_are_answered_one_by_one():
    one = scored(diagnosis(finding("time_delay", [1, 2, 3]), finding("torque_gain", [3])), STRIBECK, DELAY)
    assert [answer.named for answer in one.answers] == [False, True]
    assert one.extra == ("torque_gain",)


def test_on_a_clean_log_every_finding_is_extra():
    assert scored(diagnosis(), kind="clean").extra == ()
    assert scored(diagnosis(finding("torque_gain", [1])), kind="clean").extra == ("torque_gain",)


def test_a_foreign_effect_wants_unexplained_or_a_class_and_no_confident_name():
    honest = scored(diagnosis(verdict="unexplained"), STRIBECK, kind="foreign")
    hedged = scored(
        diagnosis(finding("torque_ripple", [1], alternatives=["torque_gain"])), STRIBECK, kind="foreign"
    )
    wrong = scored(diagnosis(finding("torque_ripple", [1])), STRIBECK, kind="foreign")
    unsure = scored(diagnosis(finding("torque_ripple", [1], confidence=0.4)), STRIBECK, kind="foreign")
    assert [one.unexplained for one in (honest, hedged, wrong, unsure)] == [True, True, False, False]
    assert [one.confidently_wrong for one in (honest, hedged, wrong, unsure)] == [False, False, True, False]


def test_the_interval_of_a_rate_is_that_of_the_binomial_table():
    # Clopper-Pearson for 0 of 10: upper end 1 - 0.025^(1/10); for 5 of 10 symmetric about one half.
    assert Rate(0, 10).interval[1] == pytest.approx(1.0 - 0.025**0.1, abs=1e-9)
    assert sum(Rate(5, 10).interval) == pytest.approx(1.0, abs=1e-9)
    assert rate([True, False, True]) == Rate(2, 3)
    assert str(Rate(0, 0)).strip().endswith("-")


def test_the_brier_score_is_the_mean_square_of_misplaced_confidence():
    sure = scored(diagnosis(finding("friction_stribeck", [2], confidence=0.9)), STRIBECK)
    wrong = scored(diagnosis(finding("torque_gain", [2], confidence=0.5)), STRIBECK)
    assert brier([sure, wrong]) == pytest.approx((0.01 + 0.25) / 2.0)
    table = {(low, high): right for low, high, _, right in reliability([sure, wrong])}
    assert table[0.8, 0.9] == Rate(1, 1)
    assert table[0.0, 0.5] == Rate(0, 1)


def test_the_confusion_table_counts_what_was_answered_to_what():
    right = scored(diagnosis(finding("friction_stribeck", [2])), STRIBECK)
    clean = scored(diagnosis(), kind="clean")
    counts = confusion([right, right, clean])
    assert counts == {("friction_stribeck", "friction_stribeck"): 2, ("clean", "nothing_found"): 1}


def test_the_tables_show_rates_and_wrong_answers_only():
    right = scored(diagnosis(finding("friction_stribeck", [2])), STRIBECK)
    wrong = scored(diagnosis(finding("torque_ripple", [2])), STRIBECK)
    order = Order("single", 1, "friction_stribeck", 1.0)
    text = "\n".join(tables([(order, right), (order, wrong)]))
    assert "1/2       50 % [1.3, 98.7]" in text
    assert "friction_stribeck                  torque_ripple" in text


def test_a_run_covers_all_kinds_strengths_and_every_cause():
    listed = orders(1, 300)
    assert {one.kind for one in listed} == {"single", "combination", "clean", "foreign"}
    assert {one.strength for one in listed if one.kind == "single"} == {0.3, 1.0, 3.0}
    assert len({one.cause for one in listed if one.kind == "single"}) == len(EFFECTS)
    assert len({one.seed for one in listed}) == 300
    assert {one.noise for one in listed if one.kind == "clean"} == set(NOISES)
    assert {one.effects for one in listed if one.kind == "combination"} == {2, 3}


def test_one_cause_can_be_asked_for_alone():
    listed = orders(2, 6, cause="backlash", strength=3.0)
    assert {(one.kind, one.cause, one.strength) for one in listed} == {("single", "backlash", 3.0)}
