"""State what an estimator is: equations over the base parameters, at a robot where they depend on one.

Least squares writes its equations once. A criterion on simulated motion writes them per Gauss-Newton step, a
filter at its end. Whatever the method, its equations are solved as they are or by the semidefinite programme.
"""

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from ...arrays import BaseParameters, Indices, JointVector, Parameters
from ...regressor.factor import Factor, Weigh
from ...regressor.memory import Memory
from ..kalman.innovations import Innovations
from ..system import Criterion, System

TORQUE, POSITION, WINDOWS = "torque", "position", "windows"
"""What of a simulation is compared with the log; ``windows``: positions of free motion over short windows."""
REPLAY, CONTROLLER, PERIODS = "replay", "controller", "periods"
"""Where motion without the noise of the measured one comes from: the robot driven by the measured torque, or
by its own controller; or other periods of a motion that repeats, in which nothing is simulated."""
SIMULATED = (REPLAY, CONTROLLER)


@runtime_checkable
class Equations(Protocol):
    """Hold the equations of the fitted blocks, condensed: what precision and bootstrap are taken from."""

    @property
    def size(self) -> int:
        """Count the base parameters."""

    @property
    def columns_of(self) -> tuple[Indices, ...]:
        """Give, per joint, the base parameters that its factors run over."""

    @property
    def block_factors(self) -> tuple[tuple[Factor, ...], ...]:
        """Give, per fitted block, one factor per joint."""

    @property
    def factors(self) -> tuple[Factor, ...]:
        """Give, per joint, the factors of all fitted blocks merged."""

    @property
    def memory(self) -> tuple[Memory, ...]:
        """Give, per joint, the lagged products of the fitted rows."""

    @property
    def reversal_weights(self) -> JointVector:
        """Give, per joint, the weight of its rows beside a reversal."""

    @property
    def criterion(self) -> Criterion:
        """Say how the factors become equations."""


@runtime_checkable
class FitData(Equations, Protocol):
    """Hold the equations as they were measured, and write others from the same logs."""

    @property
    def robust(self) -> bool:
        """Tell whether rows that no model of this kind explains are weighted down."""

    def discounted(self) -> "FitData":
        """Weigh the rows beside reversals by their own noise, unless that is not wanted."""

    def weighted(self, weigh: Weigh) -> "FitData":
        """Pass over the motions again with every row weighted."""

    def simulated(self, at: Parameters) -> "FitData":
        """Take the columns of the motion that a robot of these parameters makes."""

    def instrumented(self, at: Parameters) -> "FitData":
        """Put those columns before the measured ones, as instruments."""

    def prewhitened(self, at: Parameters) -> "FitData":
        """Put simulated columns first, and take out of every row what those before it tell of its error."""

    def differentiated(self, at: Parameters, output: str) -> "FitData":
        """Take the derivatives of a simulated output, and what the log shows beyond it."""

    def compensated(self) -> "FitData":
        """Take what noise of positions adds to the products of columns out of them."""

    def whitened(self, base: BaseParameters, noise: JointVector) -> "FitData":
        """Combine the joints' rows by the covariance that noise of positions gives them; compensate too.

        `noise` is the RMS residual of every joint that these parameters leave, N m.
        """

    def filtered(self, at: Parameters, *, unscented: bool) -> tuple[Equations, Innovations]:
        """Take what a Kalman filter learns of the parameters that starts at these."""


@dataclass(frozen=True, eq=False)
class Step:
    """Hold equations whose optimum is the next estimate."""

    system: System
    data: Equations
    """The data with rows weighted as in the equations: precision and bootstrap are taken from them."""
    innovations: Innovations | None = None
    """What a filter says of itself; None where nothing was filtered."""


@runtime_checkable
class Estimator(Protocol):
    """Choose by which criterion a robot is fitted."""

    @property
    def name(self) -> str:
        """Give the name that the option `estimator` has."""

    @property
    def title(self) -> str:
        """Describe it in a few words, for a menu."""

    @property
    def needs(self) -> tuple[str, ...]:
        """List channels of the log besides position and effort, which every log has."""

    @property
    def feasible(self) -> bool:
        """Tell whether the equations are solved under the constraints of physical consistency."""

    @property
    def iterative(self) -> bool:
        """Tell whether the equations depend on the robot that they are written at."""

    @property
    def sources(self) -> tuple[str, ...]:
        """List where the motion that it simulates may come from; none where there is no choice."""

    @property
    def row_weights(self) -> bool:
        """Tell whether the option `robust`, which weights rows, has an effect."""

    def equations(self, at: Parameters | None, data: FitData) -> Step:
        """Write the equations at a robot of these standard parameters; at None before there is any.

        An iterative one then writes those of the first estimate, which needs no robot.
        """
