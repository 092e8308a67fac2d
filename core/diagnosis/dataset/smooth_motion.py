"""Give a data set with the motion's own band alone: what is above it in the positions is left out.

Noise of the positions grows with the square of frequency on its way to a torque, so that nearly all of it
lies above the motion.
"""

from dataclasses import replace

import numpy as np
from scipy.signal import butter, sosfiltfilt

from ...arrays import JointSeries, JointVector
from ...dynamics.terms.effect import step_of
from ...signals.state import MotionState, concatenate_states
from ..thresholds.dataset import BAND
from .dataset import Dataset


def with_smooth_motion(dataset: Dataset) -> Dataset:
    """Low-pass every joint's motion at its own bandwidth, forwards and backwards.

    Position, velocity and acceleration go through the same filter, so that they remain each other's
    derivatives. Torque and rows stay as they are.
    """
    bands_hz = np.max([motion.recipe.joint_bands_hz for motion in dataset.motions], axis=0)
    stretches = tuple(
        replace(stretch, state=_low_passed(stretch.state, bands_hz)) for stretch in dataset.stretches
    )
    return replace(
        dataset,
        stretches=stretches,
        state=concatenate_states([stretch.state.at(stretch.instants) for stretch in stretches]),
    )


def _low_passed(state: MotionState, bands_hz: JointVector) -> MotionState:
    rate_hz = 1.0 / step_of(state)
    filters = [butter(BAND.smooth_order, band, fs=rate_hz, output="sos") for band in bands_hz]

    def smooth(series: JointSeries) -> JointSeries:
        pairs = zip(filters, series.T, strict=True)
        return np.column_stack([sosfiltfilt(low_pass, one) for low_pass, one in pairs])

    return replace(
        state,
        position=smooth(state.position),
        velocity=smooth(state.velocity),
        acceleration=smooth(state.acceleration),
    )
