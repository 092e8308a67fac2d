"""Hold tails and quantiles to those of `scipy.stats`, which the product does not load."""

import numpy as np
import pytest
from scipy import stats

from veritorque.core.numerics.distributions import (
    binomial_at_least,
    chi2_critical,
    chi2_tail,
    deviation_by_median,
    log_normal_tail,
    normal_tail,
    poisson_at_least,
    student_quantile,
)

EXACT = 1e-12
"""Relative: these are the same functions, but for rounding."""
FREEDOMS = (1, 2, 7, 60)
CHANCES = (1e-300, 1e-12, 1e-4, 0.3, 0.5, 0.9, 0.9999)


@pytest.mark.parametrize("value", [-30.0, -1.0, 0.0, 0.3, 4.0, 37.0])
def test_tails_of_the_normal_distribution(value):
    assert normal_tail(value) == pytest.approx(stats.norm.sf(value), rel=EXACT, abs=0.0)
    assert log_normal_tail(value) == pytest.approx(stats.norm.logsf(value), rel=EXACT, abs=0.0)


def test_the_logarithm_of_a_normal_tail_has_no_smallest_number():
    assert log_normal_tail(1e6) == pytest.approx(stats.norm.logsf(1e6), rel=EXACT)
    assert normal_tail(1e6) == 0.0


@pytest.mark.parametrize("freedom", FREEDOMS)
@pytest.mark.parametrize("statistic", [0.0, 1e-3, 1.0, 12.0, 300.0])
def test_tails_of_the_chi_square_distribution(statistic, freedom):
    expected = stats.chi2.sf(statistic, freedom)
    assert chi2_tail(statistic, freedom) == pytest.approx(expected, rel=EXACT, abs=0.0)


@pytest.mark.parametrize("freedom", FREEDOMS)
@pytest.mark.parametrize("chance", CHANCES)
def test_quantiles_of_the_chi_square_and_of_the_t_distribution(chance, freedom):
    assert chi2_critical(chance, freedom) == pytest.approx(stats.chi2.isf(chance, freedom), rel=EXACT)
    above = max(chance, 1e-4)
    assert student_quantile(above, freedom) == pytest.approx(stats.t.ppf(above, freedom), rel=EXACT)


@pytest.mark.parametrize("count", [0, 1, 2, 9, 60, 100])
@pytest.mark.parametrize("mean", [1e-6, 0.4, 8.0, 90.0])
def test_chances_of_counts(count, mean):
    expected = stats.poisson.sf(count - 1, mean)
    assert poisson_at_least(count, mean) == pytest.approx(expected, rel=EXACT, abs=0.0)
    for chance in (0.5, 1.0 / (1.0 + mean)):
        expected = stats.binom.sf(count - 1, 100, chance)
        assert binomial_at_least(count, 100, chance) == pytest.approx(expected, rel=EXACT, abs=0.0)


@pytest.mark.parametrize("seed", range(3))
def test_the_deviation_by_the_median(seed):
    values = np.random.default_rng(seed).standard_t(2, 100 + seed)
    expected = stats.median_abs_deviation(values, scale="normal")
    assert deviation_by_median(values) == pytest.approx(expected, rel=EXACT)
