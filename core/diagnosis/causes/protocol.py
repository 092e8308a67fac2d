"""Define what every cause offers. CONTRIBUTING.md says which files a new one needs.

A cause is a physical hypothesis: where it can act (`sites`), which nonlinear scalars are scanned there
(`grid`), which torque it adds per unit of its linear parameters (`term`, a function of the *predicted*
torque, never of the measured one), which estimates are physically admissible, and what they mean in words.
How the search treats it is in `traits`, what it imitates in `imitation`, what it masks in `masking`.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Literal, Protocol, runtime_checkable

import numpy as np

from ...arrays import SquareMatrix, Vector
from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...robot.joint_units import prismatic_unit
from ...robot.model import RobotModel
from ..dataset.dataset import Dataset
from ..thresholds.causes import LINEARISATION

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
    is_instant: bool = False
    """Whether it says when the effect begins or ends, and not how large it is."""

    @property
    def text(self) -> str:
        """Write it with its unit and uncertainty."""
        unit = "" if self.unit == "1" else f" {self.unit}"
        return f"{number_text(self.value, 3)} ± {number_text(self.standard_deviation)}{unit}"

    @property
    def clearness(self) -> float:
        """Give its size in standard deviations."""
        return abs(self.value) / max(self.standard_deviation, 1e-300)


def number_text(value: float, digits: int = 1) -> str:
    """Write a number with so many significant digits, without an exponent where possible.

    Examples
    --------
    >>> number_text(0.0123), number_text(12.3), number_text(1234.5, 3)
    ('0.01', '10', '1230')
    """
    return f"{float(f'{value:.{digits}g}'):g}"


@dataclass(frozen=True, eq=False)
class Setting:
    """Hold all that a candidate's columns depend on."""

    dataset: Dataset
    operating_point: Prediction
    site: Site
    scalars: Scalars = field(default_factory=dict)
    """Values of the nonlinear scalars; none yet while the grid is laid out."""

    @property
    def joint(self) -> int:
        """Give the site's first joint, from 1."""
        return self.site[0]


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


def grid_size(grid: Sequence[Scalars], scalars: Scalars) -> float:
    """Count the points of a grid."""
    del scalars
    return float(len(grid))


@dataclass(frozen=True)
class SearchTraits:
    """State how the search treats the candidates of a cause: no physics, and mostly the defaults."""

    transient: bool = False
    """Whether it acts in short spans only. Noise estimated before it is known contains it, so that a scan
    says little about it."""
    like_position_noise: bool = False
    """Whether position noise, propagated to the torque, resembles it a little."""
    at_peaks: bool = False
    """Whether it acts beyond a level only, which a smoothed motion hardly passes."""
    linearisation_error: float = LINEARISATION.usual
    """Relative error of its first-order columns: no size is known better."""
    self_consistent: tuple[str, ...] = ()
    """Scalars that are the size itself: columns are linearised at the size that they yield. Causes that agree
    to first order differ in how their second order follows from it; a free scalar would lose that."""
    discrete: tuple[str, ...] = ()
    """Scalars that are taken from the grid as they are (a side, a sense), not refined."""
    onset: Mapping[str, slice] = field(default_factory=dict)
    """The scalar, if any, that is the instant (s) from which on its columns act, and the columns that show
    it. From minus infinity on they act all along."""
    largest: float = np.inf
    """Largest size of its linear parameters that a robot can have. A log that leaves all of them open beyond
    it cannot show the cause."""
    trials: Callable[[Sequence[Scalars], Scalars], float] = grid_size
    """How many trials a point of the grid was picked from: what its p-value is corrected for."""


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

    @property
    def cure(self) -> Cure:
        """Tell whether a term, a signal or the robot's description is to be corrected."""

    def sites(self, dataset: Dataset) -> Sequence[Site]:
        """List where it can act."""

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """List the values of its nonlinear scalars to be scanned; one empty mapping where it has none."""

    def term(self, at: Setting) -> Term:
        """Give its torque per unit of its linear parameters."""

    def admissible(self, solved: FittedCause) -> bool:
        """Tell whether the estimates are physically admissible: signs and sizes."""

    def represented(self, at: Setting, solved: FittedCause) -> bool:
        """Tell whether its columns represent such estimates. Where they do not, a finding is doubtful."""

    def contradicted(self, at: Setting, solved: FittedCause) -> bool:
        """Tell whether robot and motion, at the operating point, contradict the estimates."""

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Give the reported numbers, under the names of the public enumeration."""

    def statement(self, solved: FittedCause) -> str:
        """State in one sentence what is wrong, with its numbers."""

    def numbers(self, dataset: Dataset, solved: FittedCause) -> Numbers:
        """Give the numbers of the repair."""

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State in one sentence what corrects it: what changes from which value to which."""
