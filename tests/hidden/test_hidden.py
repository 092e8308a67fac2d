"""A fixed handful of hidden effects that every change has to keep finding; `make hidden` has more of them."""

import pytest

from tests.hidden.plan import Order, run
from tests.hidden.regressions import QUICK, examine

SECONDS = 15.0
SINGLES = (
    Order("single", 7001, "friction_stribeck", 3.0, robot="planar-3", duration=SECONDS),
    Order("single", 7002, "friction_load_dependent", 3.0, robot="planar-3", duration=SECONDS),
    Order("single", 7003, "time_delay", 3.0, robot="planar-2", duration=SECONDS),
    Order("single", 7004, "torque_gain", 3.0, robot="planar-3", duration=SECONDS),
    Order("single", 7005, "torque_ripple", 3.0, robot="planar-2", duration=SECONDS),
    Order("single", 7006, "joint_elasticity", 3.0, robot="planar-3", duration=SECONDS),
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
def test_what_a_clipped_torque_leaves_is_no_push():
    score = scored(Order("single", 5300508, "torque_saturation"))
    assert [answer.exact for answer in score.answers] == [True]
    assert score.extra == ()


@pytest.mark.slow
def test_two_effects_are_both_named():
    score = scored(Order("combination", 7201, strength=3.0, effects=2, robot="planar-2", duration=SECONDS))
    assert [answer.named for answer in score.answers] == [True, True]


@pytest.mark.slow
@pytest.mark.parametrize(
    "regression", QUICK, ids=lambda one: f"{one.order.cause or 'several'}-{one.order.seed}"
)
def test_what_was_answered_wrongly_once_is_named_and_nothing_else(regression):
    _, mistakes = examine(regression)
    assert mistakes == []
