"""A fixed handful of hidden effects that every change has to keep finding; `make hidden` draws more."""

import pytest

from tests.hidden.plan import Order, answered, drawn, run
from tests.hidden.score import score

SINGLES = (
    Order("single", 7001, "friction_stribeck", 3.0, robot="planar-3"),
    Order("single", 7002, "friction_load_dependent", 3.0),
    Order("single", 7003, "time_delay", 3.0, robot="planar-2"),
    Order("single", 7004, "torque_gain", 3.0, robot="planar-3"),
    Order("single", 7005, "torque_ripple", 3.0, robot="planar-2"),
    Order("single", 7006, "joint_elasticity", 3.0),
)


def scored(order):
    _, score = run(order)
    assert score is not None, "the case cannot be drawn"
    return score


@pytest.mark.slow
@pytest.mark.parametrize("order", SINGLES, ids=lambda order: order.cause)
def test_a_strong_effect_is_named_and_nothing_else(order):
    score = scored(order)
    assert [answer.named for answer in score.answers] == [True]
    assert score.extra == ()


@pytest.mark.slow
@pytest.mark.parametrize("noise", ["white", "strong_ar1"])
def test_nothing_is_named_on_a_clean_log(noise):
    score = scored(Order("clean", 7101, noise=noise, robot="planar-3"))
    assert score.extra == ()


@pytest.mark.slow
def test_a_burst_of_heavy_tailed_noise_is_no_clipped_torque():
    assert scored(Order("clean", 5301072, noise="heavy")).extra == ()


@pytest.mark.slow
def test_a_push_is_not_what_a_far_weaker_cause_leaves():
    score = scored(Order("single", 15700666, "external_contact", 3.0))
    assert [answer.exact for answer in score.answers] == [True]


@pytest.mark.slow
def test_what_a_clipped_torque_leaves_is_no_push():
    score = scored(Order("single", 5300508, "torque_saturation"))
    assert [answer.exact for answer in score.answers] == [True]
    assert score.extra == ()


@pytest.mark.slow
@pytest.mark.parametrize(
    "order",
    [
        Order("single", 13100240, "backlash"),  # on a joint whose rotor no fit tells from its link
        Order("single", 13100191, "torque_filter_lag"),  # the base parameters take up most of it
        Order("single", 13100057, "external_contact"),  # no larger than what slow noise does by itself
        Order("single", 15700714, "timestamp_jitter", 0.3),  # the noise of positions looks like a filter
        Order("single", 15700199, "payload_change"),  # the likelihood of its instant has a narrow peak
        Order("single", 15700605, "payload_change", 3.0),  # and hardly more than that peak
        Order("single", 15700597, "torque_filter_lag", 3.0),  # what it leaves of a jerk looks like pushes
        Order(
            "single", 22300597, "torque_filter_lag", 3.0
        ),  # and what it leaves of friction, like Stribeck's
    ],
    ids=lambda order: f"{order.cause}-{order.seed}",
)
def test_an_effect_that_was_out_of_sight_once_is_named_and_nothing_else(order):
    score = scored(order)
    assert [answer.exact for answer in score.answers] == [True]
    assert score.extra == ()


@pytest.mark.slow
def test_two_effects_are_both_named():
    score = scored(Order("combination", 7201, strength=3.0, effects=2, robot="planar-2"))
    assert [answer.named for answer in score.answers] == [True, True]


@pytest.mark.slow
def test_two_that_look_better_than_each_other_are_swapped_there_and_back_at_most():
    order = Order("combination", 16700779, effects=3)
    case = drawn(order)
    document = answered(case)
    swapped = [(one["cause"], *one["joints"]) for one in document["search"] if one["action"] == "swapped"]
    assert len(set(swapped)) == len(swapped) > 0
    found = score(document, case.truth, kind=order.kind, noise=case.noise, seed=order.seed)
    assert [answer.exact for answer in found.answers] == [True] * order.effects


@pytest.mark.slow
@pytest.mark.parametrize(
    "order",
    [
        Order("combination", 10100775, effects=3),  # a fit leaves five times the noise to the noise
        Order("combination", 10100780, effects=2),  # beside mains hum, and both on one joint
        Order("combination", 8900759, effects=3),  # columns that run nearly parallel
        Order("combination", 8900766, effects=2),  # on joints that follow each other
        Order("combination", 10100782, effects=2),  # one is ten degrees large
        Order("combination", 13900765, effects=3),  # the torque of two comes late with all the rest
        Order("combination", 15100784, effects=2),  # a spring beside a joint whose gear does not carry it
        Order("combination", 13900781, effects=3),  # a body joins at an instant beside a held-out block
        Order("combination", 17300770, effects=2),  # half way the noise is left what is not found yet
        Order("combination", 19700763, effects=3),  # positions so coarse that a delay may be a filter
        Order("combination", 22300790, effects=2),  # what a wrong angle leaves looks like a wrong length
        Order("combination", 21100775, effects=3),  # friction like Stribeck's that a delay does not leave
    ],
    ids=lambda order: str(order.seed),
)
def test_effects_that_hid_each_other_once_are_named_and_nothing_else(order):
    score = scored(order)
    assert [answer.named for answer in score.answers] == [True] * order.effects
    assert score.extra == ()
