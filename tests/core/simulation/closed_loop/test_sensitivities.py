"""Derivatives of simulated motion: what a second simulation shows, and nothing of a window's own start."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.simulation.worlds import mechanism
from veritorque.core.reduction.base import base_model
from veritorque.core.simulation.closed_loop.free_windows import FreeWindows
from veritorque.core.simulation.closed_loop.replay import Replay, default_gains
from veritorque.core.simulation.closed_loop.sensitivities import Sensitivities
from veritorque.core.simulation.closed_loop.simulated import SimulatedMotion
from veritorque.core.simulation.mechanism import mechanism_of

FREE = [np.zeros(3, dtype=bool)]
CHANGE = 1e-3


@pytest.fixture(scope="module")
def machine(arm):
    return mechanism(*arm, FC=1.0, FV=0.3)


def changed(machine, base, changes):
    """Give a robot with every base parameter changed, in turn."""
    pairs = zip(base.kept, changes, strict=True)
    return [
        mechanism_of(machine.model, machine.parameters + change * np.eye(len(machine.parameters))[kept])
        for kept, change in pairs
    ]


def sensitivities(machine, motion, change=CHANGE, *, of_torque):
    """Differentiate a replay by every base parameter."""
    base = base_model(machine.model)
    positions = np.vstack([tile.state.position[::50] for tile in motion.tiles()])
    source = Replay(default_gains(machine, positions, 5.0), machine)
    changes = np.full(len(base.kept), change)
    runs = [SimulatedMotion(motion, one, source) for one in [machine, *changed(machine, base, changes)]]
    return Sensitivities(base.base_of(machine.parameters), changes, [runs], of_torque=of_torque)


def stacked(source, motion):
    """Give the usable rows of all joints under each other."""
    parts = [rows[usable] for _, joints in source.rows(0, motion) for rows, usable in joints]
    return np.vstack(parts)


@pytest.mark.parametrize("of_torque", [True, False])
def test_differences_forwards_and_backwards_agree(machine, motion, of_torque):
    ahead, back = (
        stacked(sensitivities(machine, motion, change, of_torque=of_torque), motion)[:, :-1]
        for change in (CHANGE, -CHANGE)
    )
    apart = np.linalg.norm(ahead - back, axis=0) / np.linalg.norm(ahead + back, axis=0)
    assert np.max(apart) < 0.02


def residual(source, rows):
    """Give what the log shows beyond the simulation."""
    return rows[:, -1] - rows[:, :-1] @ source.base


@pytest.mark.parametrize("of_torque", [True, False])
def test_columns_times_a_small_step_are_what_the_step_changes(machine, motion, of_torque):
    own = sensitivities(machine, motion, of_torque=of_torque)
    step = 0.01 * np.where(np.arange(len(own.base)) % 2, 1.0, -1.0)
    values = machine.parameters.copy()
    values[list(base_model(machine.model).kept)] += step
    runs = [replace(run, mechanism=mechanism_of(machine.model, values)) for run in own.simulated[0][:1]]
    other = replace(own, simulated=[runs + list(own.simulated[0][1:])])
    rows = stacked(own, motion)
    before, after = residual(own, rows), residual(other, stacked(other, motion))
    foreseen = before - rows[:, :-1] @ step
    assert np.linalg.norm(after - foreseen) < 0.1 * np.linalg.norm(after - before)


def test_what_a_window_starts_from_does_not_count(arm, motion):
    machine = mechanism(*arm, FV=0.3)
    base = base_model(machine.model)
    changes = np.full(len(base.kept), CHANGE)
    robots = [machine, *changed(machine, base, changes)]
    windows = FreeWindows(
        base.base_of(machine.parameters), changes, robots, seconds=0.3, unmeasured=FREE, held=FREE
    )
    tile = next(iter(motion.tiles()))

    class Once:
        kept = len(tile.time)

        def __init__(self, velocity):
            self.velocity = velocity

        def tiles(self):
            yield replace(tile, state=replace(tile.state, velocity=self.velocity))

    plain, pushed = (
        residual(windows, stacked(windows, Once(tile.state.velocity + more)))
        for more in (0.0, np.array([1e-3, -1e-3, 1e-3]))
    )
    # For 0.3 s at 1e-3 rad/s a joint drifts by 3e-4 rad.
    assert np.abs(pushed - plain).max() < 3e-6


def test_what_drives_a_joint_of_unmeasured_torque_itself_hardly_moves_it(arm, motion):
    machine = mechanism(*arm, FV=0.3)
    base = base_model(machine.model)
    changes = np.full(len(base.kept), CHANGE)
    robots = [machine, *changed(machine, base, changes)]
    friction = [machine.model.parameters[column].name for column in base.kept].index("FV2")

    def shown(silent):
        marks = [np.arange(3) == silent]
        windows = FreeWindows(
            base.base_of(machine.parameters), changes, robots, seconds=0.3, unmeasured=marks, held=FREE
        )
        return np.linalg.norm(stacked(windows, motion)[:, friction])

    assert shown(1) < 0.1 * shown(None)
