"""A torque channel whose gain drifts is no listed cause: the residual follows its torque and time."""

import numpy as np
import pytest

from tests.conflicts.score import PLAIN
from tests.plant.cases import draw_clean
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.study import IdentifyRequest, diagnose


def diagnosed(seed, joint, gain):
    """Diagnose a planar arm, one torque of which is read with a gain of the share of the time."""
    case = draw_clean(seed, noise="white", robot="planar-3", duration=30.0)
    rows = whole_rows(case.log)
    torque, share = rows.torque.copy(), (rows.time - rows.time[0]) / np.ptp(rows.time)
    torque[:, joint - 1] *= gain(share)
    log = log_from_arrays("log", rows.time, rows.position, torque)
    return diagnose(IdentifyRequest(case.believed, (log,), PLAIN))["diagnosis"]


@pytest.mark.parametrize(
    ("seed", "joint", "gain"),
    [(10, 3, lambda share: 0.5 + share), (14, 1, lambda share: 1.0 + np.exp(-share / 0.3))],
    ids=["steadily", "fast at first"],
)
def test_a_gain_that_drifts_is_no_friction_that_warms_up_and_no_drifting_offset(seed, joint, gain):
    found = diagnosed(seed, joint, gain)
    assert found["verdict"] == "unexplained"
    assert all(one["confidence"] <= CONFIDENCE.doubtful for one in found["findings"])
    assert found["unexplained"]["pattern"]["statement"] == (
        f"The residual of joint {joint} follows its own torque times time, as with a gain that drifts"
    )
