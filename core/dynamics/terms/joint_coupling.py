"""Give the torque of an undeclared transmission coupling: a motor that turns with two joints.

The columns are those of a declared coupling, so that declaring it is the correction. Source: Janot, Vandanjon
& Gautier, IEEE Trans. Control Syst. Technol. 22(1), 2014.
"""

from dataclasses import dataclass, replace

from ...arrays import Series
from ...robot.model import Coupling, Parameter, RobotModel
from ...signals.state import MotionState
from ..term import Entry, Term
from .coupling import GearCoupling


@dataclass(frozen=True, eq=False)
class MissingCoupling(Term):
    """Model one coupled motor, whatever couplings the robot declares."""

    coupling: Coupling

    @property
    def name(self) -> str:
        """Name the effect together with its joints."""
        return "joint_coupling_" + "_".join(str(joint) for joint in self.coupling.joints)

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List IAM, FVM, FCM."""
        return GearCoupling().parameters(self._declared(robot))

    def entries(self, robot: RobotModel) -> tuple[Entry, ...]:
        """Pair the three parameters with each of the joints."""
        return GearCoupling().entries(self._declared(robot))

    def series(self, robot: RobotModel, state: MotionState) -> Series:
        """Give the torque per unit parameter."""
        # a friction share belongs to declared couplings, of which this is none
        return GearCoupling().series(self._declared(robot), replace(state, friction_share=None))

    def _declared(self, robot: RobotModel) -> RobotModel:
        return replace(robot, couplings=(self.coupling,))
