"""A log's own defects are told with it; they hide no cause and are none."""

import numpy as np
import pytest

from core.diagnosis.verdict import diagnose
from tests.core.diagnosis.scenes import look_at_arm, measured_arm
from tests.core.diagnosis.test_verdict import asked

STIFFNESS = 1.5
"""Of the spring, N m/rad."""


def spring(state):
    """Give what a spring on the second joint adds, N m."""
    torque = np.zeros_like(state.position)
    torque[:, 1] = STIFFNESS * state.position[:, 1]
    return torque


def spikes(rng, position, torque):
    where = rng.choice(len(torque), 40, replace=False)
    torque[where, rng.integers(0, 3, 40)] = 300.0
    return "outliers"


def frozen(_rng, position, torque):
    position[2000:2100], torque[2000:2100] = position[1999], torque[1999]
    return "repeated_rows"


def dead(_rng, _position, torque):
    torque[:, 0] = 0.0
    return "missing_torque"


@pytest.mark.slow
@pytest.mark.parametrize("hidden", [None, spring], ids=["nothing", "spring"])
@pytest.mark.parametrize("spoil", [spikes, frozen, dead])
def test_a_defect_of_the_log_neither_hides_a_cause_nor_makes_one(spoil, hidden):
    rows = measured_arm(hidden).look.motions[0].log.source.data
    position, torque = rows.position.copy(), rows.torque.copy()
    kind = spoil(np.random.default_rng(4), position, torque)
    scene = look_at_arm(position, torque)
    assert kind in {one.kind for one in scene.look.motions[0].log.defects}
    found = diagnose(asked(scene))
    assert [one.cause for one in found.findings] == ([] if hidden is None else ["spring_compensator"])
    assert found.verdict == ("nothing_found" if hidden is None else "causes_found")
    for size in (size for one in found.findings for size in one.quantities):
        assert abs(size.value - STIFFNESS) < 3.0 * size.standard_deviation
