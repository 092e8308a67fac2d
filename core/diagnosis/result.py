"""Hold the result of a diagnosis: findings with evidence and alternatives, and what is left."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..arrays import JointVector, Vector
from ..dynamics.prediction import Prediction
from .causes.protocol import Cure, Quantity, Site
from .dataset.dataset import Dataset
from .residual.atlas import Atlas
from .residual.learner import Predictable
from .search.hypothesis import Candidate, Hypothesis
from .search.state import Step

Verdict = Literal["causes_found", "nothing_found", "unexplained"]


@dataclass(frozen=True)
class Evidence:
    """State one number that decided, with the statistic's name."""

    statement: str
    statistic: str
    value: float


@dataclass(frozen=True)
class Alternative:
    """Name another cause that was compared on the same evidence."""

    cause: str
    joints: Site
    statistic: float
    """Rise of twice the log-likelihood that it brings in the finding's place."""
    why: str
    """Why the two are undecided, or why it was refuted."""
    separating_experiment: str
    """The motion that would separate the two; empty where it was refuted."""


@dataclass(frozen=True, eq=False)
class Curve:
    """Show one joint's residual over the coordinate that explains it, in bins."""

    coordinate: str
    unit: str
    joint: int
    centre: Vector
    before: Vector
    after: Vector
    model: Vector
    standard_error: Vector
    """Per bin: coordinate, mean residual without and with the finding, what the finding predicts, and the
    standard error of the means (N m or N)."""
    direction: Vector
    """Per bin: 1 where only forward motion counts, -1 where only backward motion does, 0 where both do."""


@dataclass(frozen=True, eq=False)
class Gain:
    """Hold what a finding gains on held-out rows."""

    before: JointVector
    after: JointVector
    """RMS residual per joint without and with it, N m or N."""
    improvement_percent: JointVector
    total_percent: float
    interval_95: tuple[float, float]
    """Improvement of the residual's RMS, per joint and on the finding's joints together, whose interval is
    from a bootstrap over contiguous blocks."""


@dataclass(frozen=True, eq=False)
class Finding:
    """Name one cause with everything that supports it.

    `predictors` is what its confidence was computed from, None of a sample check. `verified` says that an
    identification with it has predicted held-out motion significantly better.
    """

    cause: str
    title: str
    joints: tuple[int, ...]
    cure: Cure
    statement: str
    quantities: tuple[Quantity, ...]
    confidence: float
    p_value: float
    explained_fraction: float
    evidence: tuple[Evidence, ...]
    ambiguous_with: tuple[Alternative, ...]
    refuted: tuple[Alternative, ...]
    gain: Gain | None
    curve: Curve | None
    member: Candidate | None
    predictors: tuple[float, float, float] | None = None
    verified: bool = False


@dataclass(frozen=True)
class NotIdentifiable:
    """Name a cause that this motion could not have shown, why, and the motion that would."""

    cause: str
    joints: Site
    why: str
    separating_experiment: str


@dataclass(frozen=True)
class UnnamedPattern:
    """Hold an unnamed pattern that the residual follows."""

    joint: int
    """Where it acts, from 1."""
    statement: str
    """What it follows."""
    statistic: float
    log10_p: float
    """Likelihood ratio statistic (of the kurtosis its squared deviations), and the logarithm of the p-value,
    corrected for all patterns and joints."""
    mixes_channels: bool = False
    """Whether torque channels read each other by it."""


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """Hold a diagnosis."""

    verdict: Verdict
    findings: tuple[Finding, ...]
    not_identifiable: tuple[NotIdentifiable, ...]
    predictable: tuple[Predictable, ...]
    unnamed_pattern: UnnamedPattern | None
    """A pattern that what is left still follows; None where none is found."""
    atlas: Atlas
    dataset: Dataset
    operating_point: Prediction
    """The model whose prediction the causes' columns were built on."""
    none: Hypothesis
    chosen: Hypothesis
    steps: tuple[Step, ...]
    """The hypotheses without and with the causes, and the decisions of the search."""
    residual_after: np.ndarray
    """Residual with the findings, per row of the data set and joint, N m or N."""
    at_rest: JointVector
    """Per joint, the share of the residual's mean square that is friction while the joint rests or turns
    round, and was taken out of it; not a number where it hardly moves."""
