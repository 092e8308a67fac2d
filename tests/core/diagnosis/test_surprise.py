"""What happens only where nobody fits is noticed, and then other blocks are held out."""

from dataclasses import replace

import numpy as np
import pytest

from core.diagnosis.surprise import surprised, turned
from tests.core.diagnosis.made_up import nothing_found
from tests.core.diagnosis.scenes import bench_of, measured_arm

PUSH = 3.0
"""N m, on one joint for as long as a block."""


def is_surprised(*, held_out: bool | None) -> bool:
    """Push in one block that is held out, or in one that is fitted, or in none."""
    scene = measured_arm()
    torque = scene.look.torque.copy()
    if held_out is not None:
        block = scene.look.block[scene.look.held_out == held_out][0]
        torque[scene.look.block == block, 1] += PUSH
    bench = bench_of(replace(scene, look=replace(scene.look, torque=torque)), ())
    return surprised(bench, nothing_found(bench))


@pytest.mark.parametrize(("held_out", "expected"), [(True, True), (False, False), (None, False)])
def test_only_an_event_in_a_block_that_is_held_out_surprises(held_out, expected):
    assert is_surprised(held_out=held_out) is expected


def test_other_blocks_are_held_out_and_as_many():
    look = measured_arm().look
    other = turned(look)
    assert not np.any(other.held_out & look.held_out)
    assert len(np.unique(look.block[other.held_out])) == len(np.unique(look.block[look.held_out]))


def test_whole_logs_that_are_held_out_stay_so():
    look = measured_arm().look
    assert turned(replace(look, held_out=np.ones_like(look.held_out))) is None
    assert turned(replace(look, held_out=np.zeros_like(look.held_out))) is None
