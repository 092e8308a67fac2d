"""Define what every cause offers, so that a new cause is one file.

A cause is a physical hypothesis: where it can act (`sites`), which nonlinear scalars are scanned there
(`grid`), which torque it adds per unit of its linear parameters (`term`, a function of the *predicted*
torque, never of the measured one), which estimates are physically admissible, and what they mean in words.
How the search treats it is in `traits`, what it imitates in `imitation`, what it masks in `masking`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, Protocol, runtime_checkable

from ...arrays import SquareMatrix, Vector
from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...robot.joint_units import prismatic_unit
from ...robot.model import RobotModel
from ..dataset.dataset import Dataset
from .traits import SearchTraits

Cure = Literal["term", "signal", "robot"]
Scalars = Mapping[str, float]
Site = tuple[int, ...]
"""Joints that a cause acts on, counted from 1; empty for the whole robot."""
Numbers = Mapping[str, float]
"""The numbers of a repair, by name, in SI."""


@dataclass(frozen=True)
class Quantity:
    """Report one number of a finding, with its unit and standard deviation.

    `joint` is counted from 1, or None where the number belongs to the whole robot.
    """

    name: str
    joint: int | None
    unit: str
    value: float
    standard_deviation: float


@dataclass(frozen=True, eq=False)
class FittedCause:
    """Hold the estimates of one candidate: linear parameters with covariance, scalars with deviations."""

    site: Site
    values: Vector
    covariance: SquareMatrix
    scalars: Scalars
    deviations: Scalars
    slides: bool = False
    """Whether the joint is prismatic."""

    def unit(self, turning: str) -> str:
        """Give the unit of a number of the joint, from its unit on a revolute joint."""
        return prismatic_unit(turning) if self.slides else turning


@runtime_checkable
class Cause(Protocol):
    """Define one physical hypothesis about what a simulation lacks."""

    id: ClassVar[str]
    """Its name in results; published, never changed."""
    title: ClassVar[str]
    """Its name in words, for a heading."""
    experiment: ClassVar[str]
    """The motion that would show it where the present one does not."""
    coordinate: ClassVar[str]
    """The abscissa of its figure: ``velocity, position, load, time, travel`` ..."""
    traits: ClassVar[SearchTraits]
    """How the search treats it."""

    @property
    def units(self) -> tuple[tuple[str, str], ...]:
        """List name and unit of every number it reports."""
        ...

    @property
    def cure(self) -> Cure:
        """Tell whether a term, a signal or the robot's description is to be corrected."""
        ...

    def sites(self, dataset: Dataset, operating_point: Prediction) -> Sequence[Site]:
        """List where it can act."""
        ...

    def grid(self, dataset: Dataset, operating_point: Prediction, site: Site) -> Sequence[Scalars]:
        """List the values of its nonlinear scalars to be scanned; one empty mapping where it has none."""
        ...

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give its torque per unit of its linear parameters."""
        ...

    def admissible(self, solved: FittedCause) -> bool:
        """Tell whether the estimates are physically admissible: signs and sizes."""
        ...

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Give the reported numbers, under the names of the public enumeration."""
        ...

    def statement(self, solved: FittedCause) -> str:
        """State in one sentence what is wrong, with its numbers."""
        ...

    def numbers(self, dataset: Dataset, solved: FittedCause) -> Numbers:
        """Give the numbers of the repair."""
        ...

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State in one sentence what corrects it: what changes from which value to which."""
        ...
