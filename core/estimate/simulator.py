"""Simulate the motions of a problem as a robot of given parameters makes them, and differentiate them.

The simulation is compiled for some ten seconds, hence imported only where it is used.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..arrays import BaseParameters, JointSeries, Parameters
from ..reduction.base import BaseModel
from ..regressor.rows import RowSource
from ..signals.condition import Motion
from ..simulation.control.controller_check import ControllerCheck
from ..simulation.mechanism import Mechanism, mechanism_of
from .methods.method import TORQUE, WINDOWS
from .options import CONTROLLER, SimulationOptions

if TYPE_CHECKING:
    from ..simulation.closed_loop.simulated import SimulatedMotion, Source


@dataclass(frozen=True, eq=False)
class Simulator:
    """Hold motions, and what drives a robot along them."""

    base: BaseModel
    motions: tuple[Motion, ...]
    options: SimulationOptions
    controllers: tuple[ControllerCheck, ...]
    """The logs' own controllers, where these drive the robot."""
    positions: JointSeries
    """A sample of the positions along the motions."""

    def moved(self, at: Parameters) -> tuple["SimulatedMotion", ...]:
        """Give the motions of a robot of these standard parameters."""
        from ..simulation.closed_loop.simulated import SimulatedMotion

        mechanism = mechanism_of(self.base.model, at)
        pairs = zip(self.motions, self._sources(mechanism), strict=True)
        substeps = self.options.substeps
        return tuple(SimulatedMotion(motion, mechanism, source, substeps) for motion, source in pairs)

    def _sources(self, mechanism: Mechanism) -> "list[Source]":
        from ..simulation.closed_loop.controlled import Controlled
        from ..simulation.closed_loop.replay import Replay, default_gains

        if self.options.source == CONTROLLER:
            return [Controlled(check.model) for check in self.controllers]
        gains = default_gains(mechanism, self.positions, self.options.bandwidth_hz)
        return [Replay(gains, mechanism)] * len(self.motions)

    def differentiated(self, at: Parameters, output: str, changes: BaseParameters) -> RowSource:
        """Give rows of the derivatives of an output by the base parameters, at a robot.

        Parameters
        ----------
        changes
            By how much each base parameter is changed.
        """
        from ..simulation.closed_loop.free_windows import FreeWindows
        from ..simulation.closed_loop.sensitivities import Sensitivities

        pairs = zip(self.base.kept, changes, strict=True)
        robots = [at, *(at + change * np.eye(len(at))[kept] for kept, change in pairs)]
        mechanisms = [mechanism_of(self.base.model, robot) for robot in robots]
        base = self.base.base_of(at)
        if output == WINDOWS:
            seconds, substeps = self.options.window_seconds, self.options.substeps
            silent = [motion.segments[0].unmeasured for motion in self.motions]
            return FreeWindows(base, changes, mechanisms, seconds, silent, substeps)
        runs = [[own.of(one) for one in mechanisms] for own in self.moved(at)]
        return Sensitivities(base, changes, runs, of_torque=output == TORQUE)
