"""A correction under which the whole fit leaves more than a joint's torque is not applied, and unsure."""

import numpy as np
import pytest

from tests.measured import measured_log, measured_robot
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.study import IdentifyRequest, identify

ROBOT = "ur10e_open"


@pytest.mark.slow
def test_torques_in_per_cent_of_each_joint_s_largest_are_not_corrected_into_something_worse():
    """Every joint has another factor, more than are corrected at once: no set-up of a few is right."""
    rows = whole_rows(measured_log(ROBOT, "fourier_30s_12h", 635, 3510))
    percent = 100.0 * rows.torque / np.abs(rows.torque).max(axis=0)
    log = log_from_arrays("percent", rows.time, rows.position, percent)
    document = identify(IdentifyRequest(measured_robot(ROBOT), (log,), {"bootstrap": {"draws": 0}}))
    assert document["conflicts"]
    assert all(one["confidence"] <= 0.5 for one in document["conflicts"])
    assert all(joint["nrmse_of_rms_percent"] < 50.0 for joint in document["fit"])
