"""Give the motions of a problem as a robot of given parameters makes them, or as other periods know them.

The simulation is compiled for some ten seconds, hence imported only where it is used.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ..arrays import BaseParameters, JointSeries, Parameters
from ..errors import OptionError
from ..reduction.base import BaseModel
from ..regressor.rows import RowSource, Tiled
from ..signals.condition import Motion
from ..signals.periods import OtherPeriods, other_periods
from ..simulation.mechanism import Mechanism, mechanism_of
from .methods.method import CONTROLLER, PERIODS, TORQUE, WINDOWS
from .options import SimulationOptions

if TYPE_CHECKING:
    from ..simulation.closed_loop.simulated import SimulatedMotion, Source
    from ..simulation.control.controller_check import ControllerCheck


@dataclass(frozen=True, eq=False)
class SimulationSetup:
    """Hold how the logs are simulated, or which other periods stand beside them."""

    options: SimulationOptions = field(default_factory=SimulationOptions)
    controllers: tuple["ControllerCheck", ...] = ()
    """The logs' own controllers, where these drive the robot."""
    periods: tuple[OtherPeriods, ...] = ()
    """The logs' other periods, where these are taken."""


def simulation_setup(
    base: BaseModel, motions: Sequence[Motion], options: SimulationOptions
) -> SimulationSetup:
    """Find the logs' controllers, or periods, where they are asked for.

    Raises
    ------
    OptionError
        If a log does not show its controller, or none that is known, or one that was not declared.
    LogError
        If a motion does not repeat.
    """
    if options.source == CONTROLLER:
        from ..simulation.control.own_controller import controller_of

        found = tuple(controller_of(motion.log, options.controller) for motion in motions)
        return SimulationSetup(options, controllers=found)
    if options.source == PERIODS:
        return SimulationSetup(
            options, periods=tuple(other_periods(motion, base.model.robot) for motion in motions)
        )
    return SimulationSetup(options)


@dataclass(frozen=True, eq=False)
class Simulator:
    """Hold motions, and what drives a robot along them."""

    base: BaseModel
    motions: tuple[Motion, ...]
    simulation: SimulationSetup
    positions: JointSeries
    """A sample of the positions along the motions."""

    def moved(self, at: Parameters) -> tuple[Tiled, ...]:
        """Give the motions of a robot of these standard parameters, or those of other periods."""
        return self.simulation.periods or self.simulated(at)

    def simulated(self, at: Parameters) -> tuple["SimulatedMotion", ...]:
        """Simulate a robot of these standard parameters.

        Raises
        ------
        OptionError
            If the model has no inertia.
        """
        from ..simulation.closed_loop.simulated import SimulatedMotion

        self._require_inertia()
        mechanism = mechanism_of(self.base.model, at)
        pairs = zip(self.motions, self._sources(mechanism), strict=True)
        return tuple(
            SimulatedMotion(motion, mechanism, source, self._substeps(motion, mechanism))
            for motion, source in pairs
        )

    def _require_inertia(self) -> None:
        model = self.base.model
        if not {"kg", "kg m2"} & {parameter.unit for parameter in model.parameters}:
            raise OptionError(
                "a model without inertia cannot be simulated",
                evidence={"terms": [term.name for term in model.terms]},
                remedy="put rigid_body among the terms, or ask for estimator sdp, which simulates nothing",
            )

    def _substeps(self, motion: Motion, mechanism: Mechanism) -> int | None:
        """Give the steps per sample: those asked for, or as many as springs need, whichever are more."""
        asked = self.simulation.options.substeps
        if mechanism.springs is None:
            return asked
        from ..simulation.closed_loop.springs import LONGEST_ANGLE, fastest
        from ..simulation.integrate import steps_between

        angle = fastest(mechanism, self.positions) / motion.log.rate_hz
        return max(steps_between(1.0 / motion.log.rate_hz, asked), int(np.ceil(angle / LONGEST_ANGLE)))

    def _sources(self, mechanism: Mechanism) -> "list[Source]":
        from ..simulation.closed_loop.controlled import Controlled
        from ..simulation.closed_loop.replay import Replay, default_gains

        if self.simulation.controllers:
            return [Controlled(check.model) for check in self.simulation.controllers]
        gains = default_gains(mechanism, self.positions, self.simulation.options.bandwidth_hz)
        return [Replay(gains, mechanism)] * len(self.motions)

    def differentiated(self, at: Parameters, output: str, changes: BaseParameters) -> RowSource:
        """Give rows of the derivatives of an output by the base parameters, at a robot.

        Parameters
        ----------
        changes
            By how much each base parameter is changed.

        Raises
        ------
        OptionError
            If the model has no inertia.
        """
        from ..simulation.closed_loop.free_windows import FreeWindows
        from ..simulation.closed_loop.sensitivities import Sensitivities

        self._require_inertia()
        pairs = zip(self.base.kept, changes, strict=True)
        robots = [at, *(at + change * np.eye(len(at))[kept] for kept, change in pairs)]
        mechanisms = [mechanism_of(self.base.model, robot) for robot in robots]
        base = self.base.base_of(at)
        if output == WINDOWS:
            seconds, substeps = self.simulation.options.window_seconds, self.simulation.options.substeps
            silent = [motion.segments[0].unmeasured for motion in self.motions]
            held = [motion.recipe.held for motion in self.motions]
            return FreeWindows(base, changes, mechanisms, seconds, silent, held, substeps)
        runs = [[own.of(one) for one in mechanisms] for own in self.simulated(at)]
        return Sensitivities(base, changes, runs, of_torque=output == TORQUE)
