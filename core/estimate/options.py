"""Say how a robot is to be estimated: which estimator, which solver, how strongly the prior pulls.

Apart from what estimates, so that a request can be checked where nothing is computed.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from ..errors import OptionError
from ..simulation.control.declared import DeclaredController
from .constraints import Bounds
from .methods.kalman import KalmanFilter
from .methods.method import CONTROLLER, PERIODS, REPLAY, Estimator
from .methods.registry import ESTIMATORS

SOURCES = (REPLAY, CONTROLLER, PERIODS)
SOLVERS = ("clarabel", "cvxpy")
_OF_LEAST_SQUARES = {"bounds", "entropy", "robust"}
"""Options that act on estimator sdp and not on all others."""
FLEXIBLE = "didim"
"""The estimator that tells springs of joints apart."""
LEAST_SCALE = 1e-3
"""Smallest factor on what a Kalman filter assumes."""
PULL = 0.02
"""Weight of the pull towards the prior, in units of chi^2 per squared scale. A parameter that lies one scale
from the prior is pulled by a fiftieth of a deviation at most, however long the log; what the motion leaves
open goes to the prior all the same."""


@dataclass(frozen=True)
class SimulationOptions:
    """Choose how a log is simulated for estimators that simulate."""

    source: str = REPLAY
    """What drives the robot: ``replay``, the measured torque; ``controller``, its own controller, which is
    recognised in the log; ``periods``: nothing, other periods of the motion are taken. Called ``from`` in
    options and results."""
    bandwidth_hz: float = 5.0
    """Bandwidth of the controller that pulls a replayed motion to the measured one. The measured torque is
    played as it is; what the controller adds is what the model lacks."""
    substeps: int | None = None
    """Steps of the simulation per sample; if not given, as many as make a step no longer than 1 ms."""
    window_seconds: float = 0.2
    """Length of the windows of free motion (``oe``), s."""
    controller: DeclaredController = field(default_factory=DeclaredController)
    """What is known of the controller; the option `controller`."""

    def __post_init__(self) -> None:
        """Refuse what is no source, no controller, or no step."""
        if self.source not in SOURCES:
            raise OptionError(
                "a log is not simulated like that",
                evidence={"pointer": "/options/simulation/from", "given": self.source[:50]},
                remedy=f"give one of {', '.join(SOURCES)}",
            )
        substeps = 1 if self.substeps is None else self.substeps
        in_range = 0.01 <= self.bandwidth_hz <= 100.0 and 0.01 <= self.window_seconds <= 10.0
        if not in_range or not 1 <= substeps <= 100:
            raise OptionError(
                "the options of the simulation are not valid",
                evidence={
                    "bandwidth_hz": self.bandwidth_hz,
                    "substeps": self.substeps,
                    "window_seconds": self.window_seconds,
                },
                remedy="give a bandwidth from 0.01 to 100 Hz, windows from 0.01 to 10 s, and 1 to 100 steps "
                "per sample",
            )

    def acting_on(self, method: Estimator) -> "SimulationOptions":
        """Give the same without what has no effect on an estimator."""
        plain = SimulationOptions()
        if not method.iterative:
            return plain
        if not method.sources:
            return replace(plain, substeps=self.substeps, window_seconds=self.window_seconds)
        known = self if self.source in method.sources else replace(plain, bandwidth_hz=self.bandwidth_hz)
        return replace(known, window_seconds=plain.window_seconds)


@dataclass(frozen=True)
class IterationOptions:
    """Choose when an iterative estimator ends: after `most` steps, or when the torque changes by less."""

    most: int = 10
    tolerance: float = 1e-3
    """RMS change of the predicted torque over its RMS."""

    def __post_init__(self) -> None:
        """Refuse no step at all, and a tolerance that nothing meets or everything does."""
        if not 1 <= self.most <= 100 or not 1e-9 <= self.tolerance <= 0.1:
            raise OptionError(
                "the options of the iteration are not valid",
                evidence={"most": self.most, "tolerance": self.tolerance},
                remedy="give 1 to 100 steps and a tolerance from 1e-9 to 0.1",
            )


@dataclass(frozen=True)
class KalmanOptions:
    """Choose what a Kalman filter assumes."""

    position_noise: float = 1.0
    """Factor on the noise of positions that the log shows."""
    torque_noise: float = 1.0
    """Factor on the noise of torques that the first fit leaves."""
    start_scale: float = 10.0
    """Factor on the deviations of the first fit's parameters, with which the filter begins."""
    drift: float = 0.0
    """Random walk of the parameters that are followed over time, per square root of a second, as a share of
    their values; 0 for not to follow them. The estimate itself is of parameters that do not drift."""

    def __post_init__(self) -> None:
        """Refuse noise that is none, and a start that nothing corrects or nothing tells of."""
        factors = (self.position_noise, self.torque_noise, self.start_scale)
        if not all(LEAST_SCALE <= factor <= 1e3 for factor in factors) or not 0.0 <= self.drift <= 1.0:
            raise OptionError(
                "the options of the Kalman filter are not valid",
                evidence=vars(self),
                remedy="give factors from 0.001 to 1000, and a drift from 0 to 1",
            )


@dataclass(frozen=True)
class EstimateOptions:
    """Choose how to estimate."""

    estimator: str = "sdp"
    """One of the registry's names."""
    solver: str = "clarabel"
    """``clarabel`` called directly, or ``cvxpy``."""
    robust: bool = False
    """Weigh rows with Huber's function under the semidefinite programme too."""
    weigh_reversals: bool = True
    """Weigh rows beside a reversal, where the direction of friction is in doubt, by their own noise."""
    pull: float = PULL
    entropy: float = 0.0
    """Weights of the squared and of the entropic distance to the prior."""
    bounds: Bounds = field(default_factory=Bounds)
    simulation: SimulationOptions = field(default_factory=SimulationOptions)
    iteration: IterationOptions = field(default_factory=IterationOptions)
    kalman: KalmanOptions = field(default_factory=KalmanOptions)
    flexible_joints: tuple[int, ...] = ()
    """Joints, from 1, with a spring between motor and link: their stiffness and damping are estimated too."""

    @property
    def method(self) -> Estimator:
        """Give the estimator of that name."""
        return ESTIMATORS[self.estimator]

    def by(self, estimator: str) -> "EstimateOptions":
        """Give the same for another estimator, without what has no effect on it."""
        method, plain = ESTIMATORS[estimator], EstimateOptions()
        return replace(
            self,
            estimator=estimator,
            robust=self.robust and method.row_weights,
            simulation=self.simulation.acting_on(method),
            iteration=self.iteration if method.iterative else plain.iteration,
            kalman=self.kalman if isinstance(method, KalmanFilter) else plain.kalman,
            flexible_joints=self.flexible_joints if estimator == FLEXIBLE else (),
        )

    @property
    def simulates_controllers(self) -> bool:
        """Tell whether the logs' own controllers are simulated."""
        return self.method.iterative and self.simulation.source == CONTROLLER

    def __post_init__(self) -> None:
        """Refuse unknown names and weights that are not valid."""
        if self.estimator not in ESTIMATORS or self.solver not in SOLVERS:
            raise OptionError(
                "the estimator or solver is not known",
                evidence={
                    "estimator": self.estimator,
                    "known": list(ESTIMATORS),
                    "solver": self.solver,
                    "solvers": list(SOLVERS),
                },
                remedy="choose one of the known names",
            )
        self._check_source()
        self._check_flexible()
        without_effect = self._without_effect()
        if without_effect:
            helps = "ask for estimator sdp, or " * (set(without_effect) <= _OF_LEAST_SQUARES)
            raise OptionError(
                f"{' and '.join(without_effect)} would have no effect on this estimator",
                evidence={"estimator": self.estimator, "without_effect": without_effect},
                remedy=f"{helps}leave these options out",
            )
        if not 0.0 < self.pull <= 1e6 or not 0.0 <= self.entropy <= 1e6:
            raise OptionError(
                "the weights of the prior are not valid",
                evidence={"pull": self.pull, "entropy": self.entropy},
                remedy="give a pull above 0 and up to 1e6, and an entropy from 0 to 1e6",
            )
        if self.entropy > 0.0 and self.solver != "cvxpy":
            raise OptionError(
                "the entropic prior is stated in cvxpy only",
                evidence={"entropy": self.entropy, "solver": self.solver},
                remedy="ask for solver cvxpy together with entropy",
            )

    def _check_source(self) -> None:
        """Refuse motion that the estimator cannot use."""
        method, source = self.method, self.simulation.source
        if method.sources and source not in method.sources:
            others = [name for name, other in ESTIMATORS.items() if source in other.sources]
            raise OptionError(
                f"the estimator {method.name} takes no motion from {source}",
                evidence={"pointer": "/options/simulation/from", "known": list(method.sources)},
                remedy=f"ask for one of {', '.join(others)}, or simulate from {' or '.join(method.sources)}",
            )

    def _check_flexible(self) -> None:
        """Refuse flexible joints that are none, and an estimator or a simulation that knows none."""
        joints = self.flexible_joints
        if joints and (self.estimator, self.simulation.source) != (FLEXIBLE, REPLAY):
            raise OptionError(
                "flexible joints are estimated by didim from replayed logs only",
                evidence={
                    "pointer": "/options/flexible_joints",
                    "estimator": self.estimator,
                    "simulation": self.simulation.source,
                },
                remedy=f"ask for estimator {FLEXIBLE} with simulation.from {REPLAY}, or leave the option out",
            )
        if list(joints) != sorted(set(joints)) or min(joints, default=1) < 1:
            raise OptionError(
                "the flexible joints are not valid",
                evidence={"pointer": "/options/flexible_joints", "given": list(joints)},
                remedy="list numbers of joints from 1, rising, each once",
            )

    def _without_effect(self) -> list[str]:
        """List the options that have been set and would not act on this estimator."""
        method, simulation, usual = self.method, self.simulation, SimulationOptions()
        controlled = (simulation.source, simulation.bandwidth_hz) != (usual.source, usual.bandwidth_hz)
        simulated = (simulation.bandwidth_hz, simulation.substeps) != (usual.bandwidth_hz, usual.substeps)
        free = method.iterative and not method.sources
        plain = replace(simulation, controller=usual.controller)
        options: Mapping[str, tuple[bool, bool]] = {
            "bounds": (method.feasible, self.bounds != Bounds()),
            "entropy": (method.feasible, self.entropy > 0.0),
            "robust": (method.row_weights, self.robust),
            "simulation": (method.iterative, plain != usual),
            "simulation.from and simulation.bandwidth_hz": (not free, controlled),
            "simulation.bandwidth_hz and simulation.substeps": (simulation.source != PERIODS, simulated),
            "simulation.window_seconds": (free, simulation.window_seconds != usual.window_seconds),
            "controller without simulation.from controller": (
                self.simulates_controllers,
                simulation.controller != usual.controller,
            ),
            "iteration": (method.iterative, self.iteration != IterationOptions()),
            "kalman": (isinstance(method, KalmanFilter), self.kalman != KalmanOptions()),
        }
        without = [name for name, (acts, is_set) in options.items() if is_set and not acts]
        return [name for name in without if not ("simulation" in without and name.startswith("simulation."))]
