"""Hide effects of the transmission: an elastic joint, play, a coupling or a rotor that nobody declared."""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from tests.plant.controller import BANDWIDTH, Steering
from tests.plant.effects.effect import Effect, Hidden
from tests.plant.effects.friction import any_joint
from tests.plant.robots import Arm
from veritorque.core.robot.model import Coupling, RobotModel


@dataclass(frozen=True)
class JointElasticity(Effect):
    """Put a spring and a damper between motor, where encoder and friction are, and link."""

    stiffness: float
    damping: float
    cause = "joint_elasticity"
    draw_order = 8
    parameters = ("stiffness", "damping")
    units: ClassVar = {"stiffness": "N m/rad", "damping": "N m s/rad"}
    splits = True

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a resonance against the locked motor between 15 and 40 Hz, damped by a tenth."""
        joints = any_joint(rng, arm)
        inertia = steering.gain[joints[0] - 1] / BANDWIDTH**2
        rate = 2.0 * np.pi * rng.uniform(15.0, 40.0)
        return cls(joints, inertia * rate**2, 0.2 * inertia * rate)

    def scaled(self, factor: float) -> Self:
        """Soften the spring by the factor and keep the share of critical damping."""
        return replace(self, stiffness=self.stiffness / factor, damping=self.damping / np.sqrt(factor))

    def transmit(self, twist: float, rate: float) -> float:
        """Pull spring and damper."""
        return self.stiffness * twist + self.damping * rate

    def twist(self, torque: float) -> float:
        """Wind the spring up."""
        return torque / self.stiffness


@dataclass(frozen=True)
class Backlash(Effect):
    """Let the link move freely within the amplitude half_width; stiff, damped contact beyond."""

    half_width: float
    contact: float
    damping: float
    cause = "backlash"
    draw_order = 9
    parameters = ("half_width",)
    units: ClassVar = {"half_width": "rad"}
    sizes = ("half_width",)
    largest = 0.02
    splits = True

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a joint; the contact rings at 1000 rad/s, which is far above what the log shows."""
        joints = any_joint(rng, arm)
        rotor = arm.rotor_inertia[joints[0] - 1]
        link = max(steering.gain[joints[0] - 1] / BANDWIDTH**2 - rotor, 0.1 * rotor)
        reduced = rotor * link / (rotor + link)
        return cls(joints, 1e-3, 1000.0**2 * reduced, 600.0 * reduced)

    def transmit(self, twist: float, rate: float) -> float:
        """Press where there is contact, never pull."""
        into = abs(twist) - self.half_width
        if into <= 0.0:
            return 0.0
        side = 1.0 if twist > 0.0 else -1.0
        return side * max(self.contact * into + self.damping * side * rate, 0.0)

    def twist(self, torque: float) -> float:
        """Lean on the side of the load, in the middle where there is none."""
        return float(np.sign(torque) * self.half_width + torque / self.contact)


@dataclass(frozen=True)
class JointCoupling(Effect):
    """Let a motor turn with the sum of two joints, and the user not know it.

    The motor's inertia Iam, viscous friction Fvm and Coulomb friction Fcm act on the sum of both speeds, with
    the same torque on both joints.
    """

    Fvm: float
    Fcm: float
    Iam: float
    cause = "joint_coupling"
    draw_order = 10
    parameters = ("Fvm", "Fcm", "Iam")
    units: ClassVar = {"Fvm": "N m s/rad", "Fcm": "N m", "Iam": "kg m2"}
    sizes = ("Fvm", "Fcm", "Iam")

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Take the arm's own coupling, or couple two neighbours."""
        if len(arm.motors):
            rotor, viscous, coulomb = arm.motors[0]
            return cls(arm.robot.couplings[0].joints, viscous, coulomb, rotor)
        second = int(rng.integers(2, arm.joints + 1))
        own = second - 1
        return cls(
            (second - 1, second), 0.4 * arm.viscous[own], 0.5 * arm.coulomb[own], 0.3 * arm.rotor_inertia[own]
        )

    def truth(self) -> tuple[Hidden, ...]:
        """Number the motor as the joint that it drives."""
        return tuple(replace(one, joint=self.joints[1]) for one in super().truth())

    def true(self, arm: Arm) -> Arm:
        """Couple the joints."""
        coupling = Coupling("undeclared", self.joints[1], self.joints, (1.0, 1.0))
        motors = np.array([[self.Iam, self.Fvm, self.Fcm]])
        return replace(arm, robot=replace(arm.robot, couplings=(coupling,)), motors=motors)

    def believed(self, robot: RobotModel) -> RobotModel:
        """Know nothing of it."""
        return replace(robot, couplings=())


@dataclass(frozen=True)
class RotorInertiaMissing(Effect):
    """Give one joint a rotor inertia IA which the user has left out of the model."""

    IA: float
    cause = "rotor_inertia_missing"
    draw_order = 11
    parameters = ("IA",)
    units: ClassVar = {"IA": "kg m2"}
    sizes = ("IA",)

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a joint; the first one's rotor is part of ZZ1 and is never missed."""
        joint = int(rng.integers(2, arm.joints + 1))
        return cls((joint,), float(arm.rotor_inertia[joint - 1]))

    def true(self, arm: Arm) -> Arm:
        """Set the inertia."""
        rotors = arm.rotor_inertia.copy()
        rotors[self.own] = self.IA
        return replace(arm, rotor_inertia=rotors)

    def believed(self, robot: RobotModel) -> RobotModel:
        """Leave it out."""
        joints = tuple(
            replace(joint, rotor_inertia=False) if place == self.own else joint
            for place, joint in enumerate(robot.joints)
        )
        return replace(robot, joints=joints)
