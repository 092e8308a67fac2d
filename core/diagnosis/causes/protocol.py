"""Say what every cause must offer, so that a new cause is one file.

A cause is a hypothesis about the world: where it can act (`sites`), which nonlinear scalars have to be
scanned there (`grid`), and which torque it adds per unit of its linear parameters (`term`, built on the
*predicted* torque, never on the measured one). It also says in words what it means, what it is easily
confused with, and which motion would separate the two.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, Protocol, runtime_checkable

from ...arrays import SquareMatrix, Vector
from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...robot.joint_units import along_slide
from ...robot.model import RobotModel
from ..dataset.dataset import Dataset
from .traits import SearchTraits

Cure = Literal["term", "signal", "robot"]
Scalars = Mapping[str, float]
Site = tuple[int, ...]
"""Joints that a cause acts on, counted from 1; empty for the whole robot."""
Numbers = Mapping[str, float]
"""What a repair is done with, by name, in SI."""


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
    """Carry what a fit found for one candidate.

    Linear parameters come with their covariance, scanned scalars with their deviations.

    Attributes
    ----------
    slides
        Whether the joint that it is about slides.
    """

    site: Site
    values: Vector
    covariance: SquareMatrix
    scalars: Scalars
    deviations: Scalars
    slides: bool = False

    def unit(self, turning: str) -> str:
        """Give the unit of a number of the joint, from what it is where joints turn."""
        return along_slide(turning) if self.slides else turning


@runtime_checkable
class Cause(Protocol):
    """Offer one hypothesis about what a simulation misses.

    Attributes
    ----------
    id
        Its name in results.
    title
        What it is, in words that fit a heading.
    experiment
        The motion that would show it where the present one does not.
    coordinate
        What its figure has on the abscissa: ``velocity, position, load, time, travel`` ...
    traits
        What the search has to know of it.
    """

    id: ClassVar[str]
    title: ClassVar[str]
    experiment: ClassVar[str]
    coordinate: ClassVar[str]
    traits: ClassVar[SearchTraits]

    @property
    def units(self) -> tuple[tuple[str, str], ...]:
        """List name and unit of every number it reports."""
        ...

    @property
    def cure(self) -> Cure:
        """Tell whether a term, a signal or the robot's description is to be mended."""
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
        """Tell whether nature allows the parameters found: signs and sizes."""
        ...

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Give the numbers a reader wants, under the names of the public enumeration."""
        ...

    def statement(self, solved: FittedCause) -> str:
        """Say in one sentence, with the numbers filled in, what is wrong and what it does."""
        ...

    def numbers(self, dataset: Dataset, solved: FittedCause) -> Numbers:
        """Give the numbers that a repair is done with."""
        ...

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """Say in one sentence, with the numbers filled in, what mends it: what goes from what to what."""
        ...
