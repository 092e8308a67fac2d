"""What happens only where nobody fits is noticed, and then other blocks are held out."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.diagnosis.made_up import nothing_found
from tests.core.diagnosis.scenes import fitter_of, measured_arm
from veritorque.core.diagnosis.checks.holdout_outliers import (
    Explained,
    has_holdout_outliers,
    with_other_holdout,
    with_typical_holdout,
)
from veritorque.core.diagnosis.dataset.dataset import Dataset

PUSH = 3.0
"""N m, on one joint for as long as a block."""


def plain(dataset: Dataset) -> Explained:
    fitter = fitter_of(replace(measured_arm(), dataset=dataset), ())
    return fitter, nothing_found(fitter)


def pushed(*blocks: int) -> Dataset:
    dataset = measured_arm().dataset
    torque = dataset.torque.copy()
    torque[np.isin(dataset.block, blocks), 1] += PUSH
    return replace(dataset, torque=torque)


def blocks_of(dataset: Dataset, *, held_out: bool) -> np.ndarray:
    return np.unique(dataset.block[dataset.held_out == held_out])


HELD, FITTED = (int(blocks_of(measured_arm().dataset, held_out=one)[0]) for one in (True, False))
TURNED = int(blocks_of(with_other_holdout(measured_arm().dataset), held_out=True)[0])
"""A block that is held out once others are."""


@pytest.mark.parametrize(("blocks", "expected"), [((HELD,), True), ((FITTED,), False), ((), False)])
def test_only_an_event_in_a_block_that_is_held_out_surprises(blocks, expected):
    assert has_holdout_outliers(*plain(pushed(*blocks))) is expected


@pytest.mark.parametrize(("blocks", "other"), [((HELD,), True), ((FITTED,), False), ((), False)])
def test_blocks_that_do_not_surprise_are_held_out_from_the_first(blocks, other):
    dataset = pushed(*blocks)
    chosen = with_typical_holdout(dataset, plain(dataset), plain)
    assert bool(np.any(chosen.held_out & (dataset.block == TURNED))) is other


def test_blocks_stay_held_out_where_others_would_surprise_as_well():
    dataset = pushed(HELD)
    surprising = plain(dataset)
    assert with_typical_holdout(dataset, surprising, lambda _other: surprising) is dataset


def test_other_blocks_are_held_out_and_as_many():
    dataset = measured_arm().dataset
    other = with_other_holdout(dataset)
    assert not np.any(other.held_out & dataset.held_out)
    assert len(np.unique(dataset.block[other.held_out])) == len(np.unique(dataset.block[dataset.held_out]))


def test_blocks_in_which_a_joint_rests_are_not_held_out_instead():
    dataset = measured_arm().dataset
    resting = dataset.clear.copy()
    resting[dataset.block == TURNED, 1] = False
    assert with_other_holdout(replace(dataset, clear=resting)) is None


def test_whole_logs_that_are_held_out_stay_so():
    dataset = measured_arm().dataset
    assert with_other_holdout(replace(dataset, held_out=np.ones_like(dataset.held_out))) is None
    assert with_other_holdout(replace(dataset, held_out=np.zeros_like(dataset.held_out))) is None
