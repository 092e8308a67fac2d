"""Write down stationary noise exactly: autocovariances, predictors, dense covariances, and draws."""

import numpy as np
from scipy.linalg import solve_toeplitz, toeplitz
from scipy.signal import lfilter
from scipy.stats import chi2

from veritorque.core.diagnosis.regression.ar_noise import ARNoise

WHITE: tuple[float, ...] = ()
SLOW = (0.9,)
WAVY = (1.6, -1.1, 0.3)
"""Weights of the last values, the latest first."""
LONG = 4096


def autocovariance(weights: tuple[float, ...], count: int) -> np.ndarray:
    """Give the autocovariances of an autoregression with unit innovations, by its impulse response."""
    response = lfilter([1.0], [1.0, *(-np.array(weights))], np.eye(1, LONG)[0])
    return np.array([response[: LONG - lag] @ response[lag:] for lag in range(count)])


def exact_noise(weights: tuple[float, ...]) -> ARNoise:
    """Give the best predictors from 0, 1, ... p past values, from the normal equations."""
    gamma = autocovariance(weights, len(weights) + 1)
    predictors = [np.zeros(0)] + [
        solve_toeplitz(gamma[:order], gamma[1 : order + 1]) for order in range(1, len(weights) + 1)
    ]
    variances = [gamma[0] - one @ gamma[1 : len(one) + 1] for one in predictors]
    return ARNoise(tuple(predictors), np.sqrt(variances))


def dense_covariance(weights: tuple[float, ...], place: np.ndarray) -> np.ndarray:
    """Give the covariance of rows whose runs know nothing of each other."""
    run = np.cumsum(place == 0)
    return toeplitz(autocovariance(weights, len(place))) * (run[:, None] == run)


def drawn(weights: tuple[float, ...], rng: np.random.Generator, count: int, columns: int = 1) -> np.ndarray:
    """Draw noise with unit innovations, count x columns, long after its beginning."""
    return lfilter([1.0], [1.0, *(-np.array(weights))], rng.normal(size=(count + 500, columns)), axis=0)[500:]


def ljung_box(series: np.ndarray, *, lags: int = 40, fitted: int = 0) -> float:
    """Give the chance that white noise shows autocorrelations as large (Ljung & Box, Biometrika 65, 1978)."""
    count = len(series)
    found = np.array([series[lag:] @ series[:-lag] for lag in range(1, lags + 1)]) / (series @ series)
    statistic = count * (count + 2) * np.sum(found**2 / (count - np.arange(1, lags + 1)))
    return float(chi2.sf(statistic, lags - fitted))
