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

Cure = Literal["term", "signal", "robot"]
Scalars = Mapping[str, float]
Site = tuple[int, ...]
"""Joints that a cause acts on, counted from 1; empty for the whole robot."""
Numbers = Mapping[str, float]
"""What a repair is done with, by name, in SI."""


@dataclass(frozen=True)
class Confusion:
    """Name another cause that leaves much the same trace, why, and the experiment that separates the two.

    Attributes
    ----------
    share
        A lead over it of less than this share of a finding's rise counts for nothing: columns of a real robot
        are not exact, and what they miss grows with the effect.
    """

    cause: str
    why: str
    experiment: str
    share: float = 0.15


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
    event
        Whether it acts in short spans only. Noise learned before it is known holds it, so that a scan says
        little about it.
    like_position_noise
        Whether noise of the positions, on its way to a torque, passes for a little of it.
    inexact
        Share of a size that its columns, which are of first order, are inexact by: none is known better.
    """

    id: ClassVar[str]
    title: ClassVar[str]
    experiment: ClassVar[str]
    coordinate: ClassVar[str]
    event: ClassVar[bool]
    like_position_noise: ClassVar[bool]
    inexact: ClassVar[float]

    @property
    def units(self) -> tuple[tuple[str, str], ...]:
        """List name and unit of every number it reports."""
        ...

    @property
    def cure(self) -> Cure:
        """Tell whether a term, a signal or the robot's description is to be mended."""
        ...

    @property
    def confusions(self) -> tuple[Confusion, ...]:
        """List what it is mistaken for."""
        ...

    @property
    def excludes(self) -> tuple[str, ...]:
        """List causes that are not added once it is there: they would share out one effect."""
        ...

    @property
    def leaves(self) -> tuple[str, ...]:
        """List causes that what it leaves looks like: beside it, they have to be nearly as clear.

        Of events only those count that happen while it acts.
        """
        ...

    @property
    def unrefined(self) -> tuple[str, ...]:
        """List scalars that are taken from the grid as they are (a side, a sense), not refined."""
        ...

    @property
    def onset(self) -> Mapping[str, slice]:
        """Name the scalar, if any, that is the instant from which on its columns act, and those that show it.

        In s; from minus infinity on they act all along.
        """
        ...

    @property
    def yielded(self) -> tuple[str, ...]:
        """List scalars that are the size itself: columns are built where they yield what they are built for.

        Causes that agree to first order differ by how their second order follows from it; a free scalar would
        give that away.
        """
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

    def trials(self, grid: Sequence[Scalars], scalars: Scalars) -> float:
        """Count the trials that a point of the grid was picked from: what its p-value is corrected for."""
        ...

    def possible(self, solved: FittedCause) -> bool:
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
