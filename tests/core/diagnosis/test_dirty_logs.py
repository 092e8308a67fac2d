"""A log's own defects are told with it; they hide no cause and are none."""

import numpy as np
import pytest

from tests.core.diagnosis.scenes import look_at_arm, measured_arm
from tests.core.diagnosis.test_diagnose import asked
from veritorque.core.diagnosis.diagnose import diagnose

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


def stalled(_rng, position, torque):
    for first in (1000, 2000, 2900):
        rows = slice(first, first + 15)
        position[rows], torque[rows] = position[first - 1], torque[first - 1]
    return "repeated_rows"


def dead(_rng, _position, torque):
    torque[:, 0] = 0.0
    return "missing_torque"


def deaf(_rng, _position, torque):
    torque[1000:1030] = torque[999]
    return "stuck_channel"


def hung(_rng, position, _torque):
    position[2000:2060, 1] = position[1999, 1]
    return "stuck_channel"


def filled(_rng, position, torque):
    for values in (position, torque):
        values[2000:2100] = np.linspace(values[1999], values[2100], 102)[1:-1]
    return "filled_rows"


def braked(rng, position, torque):
    went = np.minimum(np.arange(1.0, 201.0), 30.0)
    first = len(position) - len(went)
    speed = position[first - 1] - position[first - 2]
    position[first:] = position[first - 1] + np.outer(went - went**2 / 60.0, speed)
    torque[first:] = 0.02 * np.std(torque, axis=0) * rng.normal(size=(len(went), torque.shape[1]))
    return "unpowered"


def replayed(_rng, position, torque):
    torque[2000:2050] = torque[1950:2000]
    position[2600:2630], torque[2600:2630] = position[2560:2590], torque[2560:2590]
    return "replayed_rows"


def clipped(_rng, _position, torque):
    torque[:, 2] = np.clip(torque[:, 2], *(0.85 * np.abs(torque[:, 2]).max() * np.array([-1.0, 1.0])))
    return "saturation"


@pytest.mark.slow
@pytest.mark.parametrize("hidden", [None, spring], ids=["nothing", "spring"])
@pytest.mark.parametrize(
    "spoil", [spikes, frozen, stalled, dead, deaf, hung, filled, braked, replayed, clipped]
)
def test_a_defect_of_the_log_neither_hides_a_cause_nor_makes_one(spoil, hidden):
    rows = measured_arm(hidden, seconds=14.0).dataset.motions[0].log.source.data
    position, torque = rows.position.copy(), rows.torque.copy()
    kind = spoil(np.random.default_rng(4), position, torque)
    scene = look_at_arm(position, torque)
    assert kind in {one.kind for one in scene.dataset.motions[0].log.defects}
    found = diagnose(asked(scene))
    told = {stalled: ["dropped_samples"], clipped: ["torque_saturation"]}.get(spoil, [])
    said = [*told, *([] if hidden is None else ["spring_compensator"])]
    assert [one.cause for one in found.findings] == said
    assert found.verdict == ("causes_found" if said else "nothing_found")
    for size in (size for one in found.findings if one.cause not in told for size in one.quantities):
        assert abs(size.value - STIFFNESS) < 3.0 * size.standard_deviation
