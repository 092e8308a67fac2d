"""Multi-step prediction on logs simulated by pinocchio: the true model's error is that of the noise."""

import numpy as np
import pytest

from tests.core.simulation.logs import RATE_HZ, logged
from tests.core.simulation.worlds import mechanism
from veritorque.core.errors import LogError, OptionError
from veritorque.core.simulation.multistep import MultiStepOptions, compare, predict_motion
from veritorque.core.simulation.windows import windows


def test_the_true_model_has_a_hundredth_of_the_error_of_no_model(arm, motion):
    found = predict_motion(mechanism(*arm, FC=1.0), (motion,))
    assert len(found.keys) > 40
    assert np.all(found.position_rms < 0.01 * found.still_rms)


def test_torque_noise_pushes_the_motion_as_far_as_double_integration_says(arm):
    # Blind to coupling: white torque noise s over an inertia m, n steps of dt: rms = s/m dt^2 sqrt(n^3 / 3).
    noise, true = 1.0, mechanism(*arm, FC=1.0)
    quiet, loud = (predict_motion(true, (logged(*arm, noise=one),)) for one in (0.0, noise))
    added = np.sqrt(np.maximum(loud.position_rms**2 - quiet.position_rms**2, 0.0))
    stiffest = np.linalg.svd(np.median(true.mass_matrices(np.zeros((1, 3))), axis=0), compute_uv=False)
    steps = np.array(loud.horizons) * RATE_HZ
    unit = noise * np.sqrt(steps**3 / 3.0) / RATE_HZ**2
    assert np.all(added > 0.2 * unit[:, None] / stiffest[0])
    assert np.all(added < 5.0 * unit[:, None] / stiffest[-1])


def test_a_wrong_model_is_found_worse_on_the_same_windows_and_by_how_much(arm, motion):
    robot, bodies = arm
    heavy = bodies.copy()
    heavy[-1] *= 1.5
    both = compare(mechanism(robot, heavy, FC=1.0), mechanism(robot, bodies, FC=1.0), (motion,))
    assert both.before.keys == both.after.keys
    assert np.array_equal(both.before.begins, both.after.begins)
    assert np.all(both.gain_percent > 80.0)
    assert np.all(both.total_gain_percent > 80.0)


def test_held_out_blocks_alone_give_the_windows_that_all_blocks_give_there(arm, motion):
    chosen = frozenset({(0, 2), (0, 5)})
    true = mechanism(*arm, FC=1.0)
    alone, all_ = predict_motion(true, (motion,), chosen=chosen), predict_motion(true, (motion,))
    assert set(alone.keys) == chosen
    np.testing.assert_allclose(alone.position, all_.within(chosen).position, atol=1e-12)


def test_windows_stay_within_their_block_and_hold_what_was_measured(motion):
    (cut,) = windows((motion,), 0.2, 0.1)
    borders = (
        np.array([motion.kept * number // 8 for number in range(9)]) * motion.recipe.decimation / RATE_HZ
    )
    numbers = np.array([block for _, block in cut.keys])
    assert np.all(cut.begins >= borders[numbers] - 1e-9)
    assert np.all(cut.begins + 0.2 <= borders[numbers + 1] + 1e-9)
    rows = motion.log.source.rows(0, motion.log.samples)
    first = np.rint(cut.begins * RATE_HZ).astype(int)
    np.testing.assert_allclose(cut.torque[7].T, rows.torque[first + 7], atol=1e-12)
    np.testing.assert_allclose(cut.position[7].T, rows.position[first + 7], atol=1e-4)


def test_windows_longer_than_a_block_are_refused_with_the_longest_there_is(arm, motion):
    with pytest.raises(LogError, match="as long as a simulated window") as refusal:
        predict_motion(mechanism(*arm), (motion,), MultiStepOptions(horizons=(3.0,)))
    assert 0.5 < refusal.value.evidence["longest_seconds"] < 1.1


@pytest.mark.parametrize("horizons", [(), (0.2, 0.1), (-1.0,), (20.0,)])
def test_horizons_that_make_no_sense_are_refused(horizons):
    with pytest.raises(OptionError, match="horizons"):
        MultiStepOptions(horizons=horizons)
