"""Compute from a noise model its correlation length, and the covariance of weighted sums of its rows.

The variance of a weighted sum of stationary noise is the noise's spectrum times the weights' spectrum, summed
over frequency. So the standard error of a bin includes the autocorrelation without thinning rows.
Source: Brockwell & Davis, Time Series (1991), ch. 4 and 7.
"""

from itertools import pairwise

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft

from ...arrays import Indices, Matrix, SquareMatrix, Vector
from ..regression.ar_noise import ARNoise
from ..thresholds.residual import PREDICTION

_LONGEST = 8192


def spectrum(noise: ARNoise, size: int) -> Vector:
    """Give the noise's power at the frequencies of a real transform of `size` rows; its mean is the variance.

    Examples
    --------
    White noise of deviation 2 has power 4 at every frequency:

    >>> spectrum(ARNoise((np.zeros(0),), np.array([2.0])), 4)
    array([4., 4., 4.])
    """
    weights = np.concatenate([[1.0], -noise.predictors[noise.order]])
    response = np.abs(rfft(weights, size)) ** 2
    return np.asarray(noise.deviations[noise.order] ** 2 / np.maximum(response, 1e-300))


def memory(noise: ARNoise) -> int:
    """Count the rows after which the noise counts as uncorrelated.

    Examples
    --------
    Correlations 0.5, 0.25, 0.125, 0.0625, ... stay below a tenth from the fourth row on:

    >>> memory(ARNoise((np.zeros(0), np.array([0.5])), np.array([1.0, 1.0])))
    4
    """
    covariance = irfft(spectrum(noise, _LONGEST), _LONGEST)[: _LONGEST // 2]
    correlated = np.flatnonzero(np.abs(covariance) >= PREDICTION.uncorrelated * covariance[0])
    return int(correlated[-1]) + 1


def covariance_of_sums(noise: ARNoise, weights: Matrix, begins: Indices) -> SquareMatrix:
    """Give the covariance of weighted sums of the noise.

    Parameters
    ----------
    weights
        Per row of the data set and sum, the weight of the row; zero where a row is left out.
    begins
        Rows that begin a stretch, ascending from 0; different stretches are independent.
    """
    total = np.zeros((weights.shape[1], weights.shape[1]))
    borders = np.append(begins, len(weights)).astype(int)
    for start, stop in pairwise(borders):
        size = next_fast_len(2 * int(stop - start), real=True)
        transformed = rfft(np.ascontiguousarray(weights[start:stop].T), size)
        power = spectrum(noise, size) / size
        power[1 : (size + 1) // 2] *= 2.0  # the negative frequencies
        parts = transformed.view(np.float64)  # real parts and imaginary ones: the sum is real
        total += (parts * np.repeat(power, 2)) @ parts.T
    return total
