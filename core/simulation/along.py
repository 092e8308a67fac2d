"""Evaluate along the measured motion what the state of a simulated robot does not determine.

A torque that depends on the motion before the instant (play, compliance, friction that builds up) is an input
to the simulation: its value along the measured motion, which is exact to first order in the error of the
simulated motion. An error of the torque channel moves nothing: it is subtracted from the input, and added
where a simulated channel is read.
"""

import numpy as np

from ..arrays import JointSeries
from .mechanism import Mechanism, Share
from .windows import Stretch


def memory_torque(mechanism: Mechanism, stretch: Stretch) -> JointSeries:
    """Give the torque (N m or N) that depends on the motion before, along the measured motion."""
    return _along(mechanism.with_memory, stretch)


def channel_torque(mechanism: Mechanism, stretch: Stretch) -> JointSeries:
    """Give what the torque channel shows besides the torque of the drives (N m or N)."""
    return _along(mechanism.channel, stretch)


def driving_torque(mechanism: Mechanism, stretch: Stretch) -> JointSeries:
    """Give the torque that moves what is simulated: the measured one, less both of these."""
    return np.asarray(stretch.torque - memory_torque(mechanism, stretch) - channel_torque(mechanism, stretch))


def _along(share: Share, stretch: Stretch) -> JointSeries:
    """Compute with what lies around the stretch, so that filters and differences have settled inside it."""
    return np.asarray(share.torque(stretch.around)[stretch.inside])
