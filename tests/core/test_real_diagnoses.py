"""Hold the diagnosis to measured robots: causes that are known to be there, and what their corrections gain.

Errors are the RMS of the residual over the RMS of the torque, in percent per joint, on held-out motion, at
the band of the fit. `make hidden` diagnoses a Rokae, too (see `tests.hidden.real`).
"""

import numpy as np
import pytest

from tests.hidden.real import diagnosed, percents
from tests.measured import FRANKA_ROWS, TX40_TEST, TX40_TRAIN, measured_log, measured_robot
from tests.truths.change import scaled, with_row
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE
from veritorque.core.extension.result import Extension

UR10E_FIT = ("fourier_30s_12h", 635, 3510)

pytestmark = pytest.mark.slow


def _named(found: Extension) -> set[tuple[str, tuple[int, ...]]]:
    return {(one.cause, one.joints) for one in found.diagnosis.findings}


def test_the_coupled_wrist_of_a_tx40_that_nobody_declared_is_named_and_then_its_lost_time():
    logs = (measured_log("staubli_tx40", "run1", *rows) for rows in (TX40_TRAIN, TX40_TEST))
    found = diagnosed(measured_robot("staubli_tx40", coupled=False), *logs)
    before, after = (percents(one.validation) for one in (found.before, found.after))
    assert ("joint_coupling", (5, 6)) in _named(found)
    assert np.all(before[4:] > 30.0)
    assert np.all(after[4:] <= (13.0, 11.0))
    (delay,) = (one for one in found.diagnosis.findings if one.cause == "time_delay")
    assert 1e-3 < abs(delay.quantities[0].value) < 3e-3


def test_a_ur10e_loses_a_third_of_its_error_on_its_heavy_joints_to_friction_that_grows_with_load():
    logs = (
        measured_log("ur10e_open", *one)
        for one in (UR10E_FIT, ("fourier_20s_8h", 320, 2310), ("fourier_40s_12h", 500, 4460))
    )
    found = diagnosed(measured_robot("ur10e_open"), *logs, logs=[3])
    assert {("friction_load_dependent", (2,)), ("friction_load_dependent", (3,))} <= _named(found)
    assert np.all(percents(found.after.validation)[:3] <= (5.6, 2.2, 2.7))


def test_a_halved_torque_of_a_wrist_is_named_though_its_friction_absorbs_nearly_all_of_it():
    halved = scaled(measured_log("ur10e_open", *UR10E_FIT), 5, 0.5)
    found = diagnosed(measured_robot("ur10e_open"), halved)
    (gain,) = (one for one in found.diagnosis.findings if one.cause == "torque_gain")
    assert gain.joints == (5,)
    assert gain.confidence > 0.8
    assert abs(gain.quantities[0].value + 0.5) < 2.0 * gain.quantities[0].standard_deviation


def test_what_a_ur10e_that_stops_at_points_leaves_on_its_wrist_is_stiction():
    points = measured_log("ur10e_open", "validation_ptp_10pts", 700, 4200)
    found = diagnosed(measured_robot("ur10e_open"), measured_log("ur10e_open", *UR10E_FIT), points, logs=[2])
    assert np.all(found.diagnosis.at_rest[4:] > (0.5, 0.9))
    assert np.all(np.array([one.share for one in found.diagnosis.predictable])[4:] < 0.2)


def test_nothing_but_faulty_samples_is_sure_on_the_first_half_of_a_pandas_run():
    half = FRANKA_ROWS // 2
    halves = (measured_log("franka_panda", "traj1", *rows) for rows in ((0, half), (half, FRANKA_ROWS)))
    found = diagnosed(measured_robot("franka_panda"), *halves, logs=[2])
    # Which doubtful ones are beside them depends on how a processor rounds.
    sure = {one.cause for one in found.diagnosis.findings if one.confidence > CONFIDENCE.doubtful}
    assert sure == {"dropped_samples", "timestamp_jitter"}
    assert found.after is None


def test_a_length_that_is_wrong_on_a_panda_is_named_though_its_torques_look_smoothed():
    wrong = with_row(measured_robot("franka_panda"), 3, r=0.1)
    found = diagnosed(wrong, measured_log("franka_panda", "traj1"))
    (length,) = (one for one in found.diagnosis.findings if one.cause == "kinematic_error")
    assert length.joints == (3,)
    assert length.confidence > 0.8
    (size, *_) = length.quantities
    assert abs(size.value + 0.1) < 2.0 * size.standard_deviation
