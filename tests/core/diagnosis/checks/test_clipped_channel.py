"""A channel that reads no more than a limit differs from a drive at its limit by what the motion needs."""

import numpy as np

from tests.core.diagnosis.scenes import ARM_RATE_HZ, skew_arm
from tests.core.dynamics.terms.motions import swinging
from tests.core.estimate.worlds import true_parameters
from veritorque.core.diagnosis.checks.clipped_channel import clipped_channels
from veritorque.core.diagnosis.dataset.dataset import Dataset, build_dataset
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.log.reader import log_from_arrays

MODEL = standard_model(skew_arm())
TRUTH = true_parameters(MODEL)
JOINT, SHARE, NOISE = 1, 0.7, 0.05


def torque() -> tuple[np.ndarray, np.ndarray]:
    """Give position and torque of the arm, with noise."""
    state = swinging(3, 20.0)
    exact = MODEL.torque(TRUTH, state)
    return state.position, exact + NOISE * np.random.default_rng(6).normal(size=exact.shape)


def look(position: np.ndarray, logged: np.ndarray) -> Dataset:
    log = log_from_arrays("arm", np.arange(len(position)) / ARM_RATE_HZ, position, logged)
    return build_dataset(MODEL, (log,), held_out=frozenset({(0, 4)}), blocks=5)


def clipped(values: np.ndarray) -> tuple[np.ndarray, float]:
    """Clip a joint's torque at a share of its largest."""
    limit = SHARE * float(np.abs(values[:, JOINT]).max())
    out = values.copy()
    out[:, JOINT] = np.clip(out[:, JOINT], -limit, limit)
    return out, limit


def test_a_clipped_channel_is_named_with_its_limit():
    position, whole = torque()
    logged, limit = clipped(whole)
    found = clipped_channels(look(position, logged), Prediction(MODEL, TRUTH))
    assert {one.site for one in found} == {(JOINT + 1,)}
    for one in found:
        assert one.quantities[0].value == limit
        assert one.residual_share[JOINT] > 0.5
        assert "clipped" in one.statement


def test_a_drive_at_its_limit_whose_motion_shows_the_limit_is_no_clipped_channel():
    """The model then predicts what was applied, which is what the channel reads."""
    position, whole = torque()
    logged, _ = clipped(whole)

    class Applied(Prediction):
        def torque(self, state):
            return clipped(super().torque(state))[0]

    assert clipped_channels(look(position, logged), Applied(MODEL, TRUTH)) == ()


def test_no_fit_sees_the_rows_at_a_limit():
    position, whole = torque()
    logged, _ = clipped(whole)
    all_rows, rest = look(position, whole), look(position, logged)
    assert np.mean(rest.usable[:, JOINT]) < np.mean(all_rows.usable[:, JOINT])
    assert np.array_equal(rest.usable[:, 0], all_rows.usable[:, 0])
    assert clipped_channels(all_rows, Prediction(MODEL, TRUTH)) == ()
