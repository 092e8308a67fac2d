"""Hold an identified robot as files need it: a model, its standard parameters, and what is known of them."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...arrays import JointVector, LinkTable, Parameters
from ...dynamics.model import DynamicModel
from ...dynamics.terms.rigid_body import RigidBody
from ...errors import OptionError
from ...robot.inertia import pseudo_inertia
from ...robot.model import Coupling, RobotModel

NEGLIGIBLE = 1e-9
"""An eigenvalue of a pseudo-inertia below this share of the largest one is rounding, not a negative."""


@dataclass(frozen=True)
class BaseValue:
    """Hold one base parameter: its name, its value in SI, and in words what is grouped in it."""

    name: str
    unit: str
    value: float
    grouping: str


@dataclass(frozen=True)
class CoupledMotor:
    """Hold a motor that turns with a sum of joints: kg m2, N m s/rad and N m of the sum."""

    coupling: Coupling
    rotor_inertia: float
    viscous: float
    coulomb: float


@dataclass(frozen=True, eq=False)
class IdentifiedRobot:
    """Hold a model with numbers."""

    model: DynamicModel
    standard: Parameters
    """The model and one value per parameter of it."""
    identifiable: tuple[str, ...]
    """Per parameter ``individually``, ``in_combination`` or ``no``."""
    base: tuple[BaseValue, ...] = ()
    """The base parameters, which the motion identifies."""
    remarks: tuple[str, ...] = ()
    """Sentences about how the numbers came about."""

    @property
    def robot(self) -> RobotModel:
        """Give the robot."""
        return self.model.robot

    @property
    def values(self) -> Mapping[str, float]:
        """Give the standard parameters by name; only a standard model names each of them once."""
        return {
            parameter.name: float(value)
            for parameter, value in zip(self.model.parameters, self.standard, strict=True)
        }

    @property
    def links(self) -> LinkTable:
        """Give the ten inertial parameters of every link.

        Raises
        ------
        OptionError
            If the model has no bodies.
        """
        for term, values in self.model.split(self.standard):
            if isinstance(term, RigidBody):
                return values.reshape(-1, 10)
        raise OptionError(
            "the identified model has no bodies, which a robot's file is about",
            evidence={"terms": [term.name for term in self.model.terms]},
            remedy="identify with the term rigid_body",
        )

    @property
    def bodies(self) -> LinkTable:
        """Give the links' ten inertial parameters, which simulators can use as bodies.

        Raises
        ------
        OptionError
            If the model has no bodies, or one of them is physically inconsistent.
        """
        for number, body in enumerate(self.links, start=1):
            eigenvalues = np.linalg.eigvalsh(pseudo_inertia(body))
            if body[9] <= 0.0 or eigenvalues[0] < -NEGLIGIBLE * eigenvalues[-1]:
                raise OptionError(
                    f"the body of link {number} is physically inconsistent, and simulators refuse it",
                    evidence={"link": number, "mass": float(body[9]), "eigenvalue": float(eigenvalues[0])},
                    remedy="identify with the estimator sdp, or take a table of parameters, which holds any",
                )
        return self.links

    def of_joints(self, symbol: str) -> JointVector:
        """Give a drive's parameter (IA, FV, FC or OFF) per joint, zero where the model has none."""
        values = self.values
        count = len(self.robot.joints)
        return np.array([values.get(f"{symbol}{number}", 0.0) for number in range(1, count + 1)])

    @property
    def motors(self) -> tuple[CoupledMotor, ...]:
        """List the coupled motors of the model."""
        values = self.values
        return tuple(
            CoupledMotor(motor, *(values[f"{symbol}{motor.number}"] for symbol in ("IAM", "FVM", "FCM")))
            for motor in self.robot.couplings
            if f"IAM{motor.number}" in values
        )
