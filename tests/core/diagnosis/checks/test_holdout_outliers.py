"""What happens only where nobody fits is noticed, and then other blocks are held out."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.diagnosis.made_up import nothing_found
from tests.core.diagnosis.scenes import bench_of, measured_arm
from veritorque.core.diagnosis.checks.holdout_outliers import Explained, surprised, turned, unsurprising
from veritorque.core.diagnosis.dataset.dataset import Look

PUSH = 3.0
"""N m, on one joint for as long as a block."""


def plain(look: Look) -> Explained:
    bench = bench_of(replace(measured_arm(), look=look), ())
    return bench, nothing_found(bench)


def pushed(*blocks: int) -> Look:
    look = measured_arm().look
    torque = look.torque.copy()
    torque[np.isin(look.block, blocks), 1] += PUSH
    return replace(look, torque=torque)


def blocks_of(look: Look, *, held_out: bool) -> np.ndarray:
    return np.unique(look.block[look.held_out == held_out])


HELD, FITTED = (int(blocks_of(measured_arm().look, held_out=one)[0]) for one in (True, False))
TURNED = int(blocks_of(turned(measured_arm().look), held_out=True)[0])
"""A block that is held out once others are."""


@pytest.mark.parametrize(("blocks", "expected"), [((HELD,), True), ((FITTED,), False), ((), False)])
def test_only_an_event_in_a_block_that_is_held_out_surprises(blocks, expected):
    assert surprised(*plain(pushed(*blocks))) is expected


@pytest.mark.parametrize(("blocks", "other"), [((HELD,), True), ((FITTED,), False), ((), False)])
def test_blocks_that_do_not_surprise_are_held_out_from_the_first(blocks, other):
    look = pushed(*blocks)
    chosen = unsurprising(look, plain(look), plain)
    assert bool(np.any(chosen.held_out & (look.block == TURNED))) is other


def test_blocks_stay_held_out_where_others_would_surprise_as_well():
    look = pushed(HELD)
    surprising = plain(look)
    assert unsurprising(look, surprising, lambda _other: surprising) is look


def test_other_blocks_are_held_out_and_as_many():
    look = measured_arm().look
    other = turned(look)
    assert not np.any(other.held_out & look.held_out)
    assert len(np.unique(look.block[other.held_out])) == len(np.unique(look.block[look.held_out]))


def test_blocks_in_which_a_joint_rests_are_not_held_out_instead():
    look = measured_arm().look
    resting = look.clear.copy()
    resting[look.block == TURNED, 1] = False
    assert turned(replace(look, clear=resting)) is None


def test_whole_logs_that_are_held_out_stay_so():
    look = measured_arm().look
    assert turned(replace(look, held_out=np.ones_like(look.held_out))) is None
    assert turned(replace(look, held_out=np.zeros_like(look.held_out))) is None
