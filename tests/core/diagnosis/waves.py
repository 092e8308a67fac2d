"""Make up causes that are waves over the angle of the second joint, so that what hides what is known."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from veritorque.core.arrays import Samples
from veritorque.core.diagnosis.causes.shared.own_joint import OwnJointCause
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.dynamics.terms.effect import OneJointTerm
from veritorque.core.signals.state import MotionState

JOINT = 2


@dataclass(frozen=True, eq=False)
class WaveTerm(OneJointTerm):
    """Add up waves over the joint's angle: amplitude in N m by waves per radian."""

    waves: Mapping[float, float]
    symbols = (("W", "N m", None),)
    kind = "wave"

    def columns(self, state: MotionState) -> list[Samples]:
        angle = state.position[:, self.joint - 1]
        return [sum(size * np.sin(rate * angle) for rate, size in self.waves.items())]


class BuiltOn(WaveTerm):
    """Say what it was built on, so that it is built anew at another operating point."""

    def __init__(self, joint: int, waves: Mapping[float, float], operating_point: Prediction) -> None:
        super().__init__(joint, waves)
        object.__setattr__(self, "believed", operating_point)


class WaveCause(OwnJointCause):
    """Candidate cause: a sum of waves on the second joint."""

    waves: ClassVar[Mapping[float, float]]
    units = (("amplitude", "N m"),)
    experiment = "any other motion"

    def sites(self, dataset):
        return [(JOINT,)]

    def term(self, at):
        return WaveTerm(at.joint, self.waves)

    def statement(self, solved):
        return f"Joint {solved.site[0]} waves"


def wave_cause(name: str, waves: Mapping[float, float]) -> WaveCause:
    """Make up a cause of a given name."""
    own = {"id": name, "title": name, "waves": waves}
    return type(name, (WaveCause,), own)()


def wave_effect(waves: Mapping[float, float]):
    """Put waves on the second joint's torque."""

    def effect(state: MotionState) -> np.ndarray:
        out = np.zeros_like(state.position)
        out[:, JOINT - 1] = sum(size * np.sin(rate * state.position[:, 1]) for rate, size in waves.items())
        return out

    return effect
