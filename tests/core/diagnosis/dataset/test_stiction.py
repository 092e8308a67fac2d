"""Park a joint: whatever its friction does then is no evidence, and it costs as much as the rest is long."""

import numpy as np
import pytest

from tests.core.diagnosis.scenes import look_at_arm
from tests.core.dynamics.terms.motions import swinging
from veritorque.core.diagnosis.dataset.dataset import Dataset
from veritorque.core.diagnosis.regression.nuisance import independent_nuisance

PARKED, MOVING = 1, 0


def parked_arm(seconds: float) -> Dataset:
    """Look at an arm whose second joint rests while noise stands for all torques."""
    position = swinging(3, seconds).position.copy()
    position[:, PARKED] = 0.3
    return look_at_arm(position, np.random.default_rng(0).normal(size=position.shape)).dataset


def is_masked(dataset: Dataset, joint: int) -> float:
    """Give the share of a joint's torque that free columns leave."""
    torque = dataset.torque[:, [joint]]
    return float(
        np.std(independent_nuisance(dataset.sticking[joint]).without_nuisance(torque)) / np.std(torque)
    )


def test_any_torque_of_a_joint_at_rest_is_taken_out_and_most_of_a_moving_ones_is_kept():
    dataset = parked_arm(10.0)
    assert is_masked(dataset, PARKED) < 1e-6
    assert is_masked(dataset, MOVING) > 0.8


@pytest.mark.parametrize("seconds", [20.0, 40.0])
def test_the_columns_of_a_rest_grow_with_its_length_and_overlap_with_their_neighbours_only(seconds):
    short, long = (parked_arm(one).sticking[PARKED] for one in (10.0, seconds))
    assert long.nnz == pytest.approx(seconds / 10.0 * short.nnz, rel=0.1)
    bands = [independent_nuisance(one).factor.shape[0] for one in (short, long)]
    assert bands[1] == pytest.approx(bands[0], rel=0.1)
