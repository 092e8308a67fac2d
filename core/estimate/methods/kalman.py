"""Follow state and parameters through the log by a Kalman filter, under the constraints at its end.

Torque drives the robot, positions correct it: no acceleration is computed from positions, and friction is
simulated as a set. What the filter knows of the parameters at its end, beyond where it began, are its
equations. Sources: Gautier & Poignet, Control Engineering Practice 9(12), 2001 (extended); Julier & Uhlmann,
Proc. IEEE 92(3), 2004, van der Merwe & Wan, ICASSP 2001 (unscented, in square-root form).
"""

from dataclasses import dataclass

from ...arrays import Parameters
from ..system import ordinary
from .method import SIMULATED, FitData, Step
from .wls import joint_equations


@dataclass(frozen=True)
class KalmanFilter:
    """Write the equations of weighted least squares first, then those of a filter that starts there."""

    name: str
    title: str
    unscented: bool
    needs: tuple[str, ...] = ()
    feasible: bool = True
    iterative: bool = True
    sources: tuple[str, ...] = SIMULATED
    row_weights: bool = False

    def equations(self, at: Parameters | None, data: FitData) -> Step:
        """Write the equations at a robot; at None those of weighted least squares."""
        if at is None:
            return joint_equations(data.discounted())
        own, innovations = data.filtered(at, unscented=self.unscented)
        return Step(ordinary(own.factors, own.columns_of, own.size), own, innovations)


EXTENDED = KalmanFilter("ekf", "extended Kalman filter, physically consistent", unscented=False)
UNSCENTED = KalmanFilter("srukf", "unscented Kalman filter, physically consistent", unscented=True)
