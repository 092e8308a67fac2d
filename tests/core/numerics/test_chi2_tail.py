"""Hold chances far below what a computer's smallest number holds to the closed form that even widths have."""

from itertools import pairwise
from math import factorial

import numpy as np
import pytest

from veritorque.core.numerics.chi2_tail import FAR, log_chi2_tail

EXACT = 1e-9
"""Of a logarithm: eight terms of the tail's series for up to a dozen parameters, and rounding."""
WIDTHS = range(1, 13)


def exact_log_chi2_tail(statistic: float, width: int) -> float:
    """Give log of exp(-s/2) times the sum of (s/2)^k / k! for k below half the width (Poisson's sum)."""
    half = 0.5 * statistic
    return -half + float(np.log(sum(half**k / factorial(k) for k in range(width // 2))))


@pytest.mark.parametrize("width", WIDTHS)
def test_the_two_ways_meet_where_one_takes_over_from_the_other(width):
    below, above = (log_chi2_tail(FAR * (1.0 + shift), width) for shift in (-1e-12, 1e-12))
    assert above == pytest.approx(below, rel=EXACT)


@pytest.mark.parametrize("width", [one for one in WIDTHS if one % 2 == 0])
@pytest.mark.parametrize("statistic", [0.5, 30.0, 999.0, 1001.0, 5e3, 1e7])
def test_of_an_even_number_of_directions_the_chance_is_a_finite_sum(statistic, width):
    assert log_chi2_tail(statistic, width) == pytest.approx(exact_log_chi2_tail(statistic, width), rel=EXACT)


@pytest.mark.parametrize("width", WIDTHS)
def test_the_larger_statistic_is_always_the_rarer_one(width):
    chances = [log_chi2_tail(float(one), width) for one in np.geomspace(1e-3, 1e12, 200)]
    assert all(later < earlier for earlier, later in pairwise(chances))
    assert np.isfinite(chances).all()


@pytest.mark.parametrize("statistic", [30.0, 2e3, 1e9])
def test_the_same_statistic_is_less_rare_the_more_directions_it_had(statistic):
    chances = [log_chi2_tail(statistic, width) for width in WIDTHS]
    assert all(later > earlier for earlier, later in pairwise(chances))


def test_no_rise_is_certain_to_be_exceeded():
    assert log_chi2_tail(0.0, 3) == log_chi2_tail(-5.0, 3) == 0.0
