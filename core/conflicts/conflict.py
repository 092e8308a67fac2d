"""Define what a conflict is: a disagreement of description and log that one correction removes."""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, Literal

from .setup import Setup
from .trial import Trials

Channel = Literal["torque", "position", "both"]


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """Say what may be wrong, and give the set-up in which it is corrected."""

    conflict: str
    """Name of its kind."""
    joints: tuple[int, ...]
    """Joints that it concerns, from 1; empty where it concerns the whole robot."""
    channel: Channel | None
    """What was measured or assigned otherwise; None where the description is wrong."""
    setup: Setup
    """The corrected set-up."""
    statement: str
    """What disagrees, in words."""
    remedy: str
    """What to do, in the imperative."""
    expected: bool = False
    """Whether the log's numbers ask for it by their size alone: it has to fit no worse, and costs nothing."""
    is_shown: bool = False
    """Whether the log shows it by itself, whatever the model says."""
    is_significant: bool = False
    """Whether least squares shows it by itself: it has to fit better than by chance only."""
    corrections: int = 1
    """Sizes that it finds by themselves: each has to gain what a correction has to."""

    @property
    def key(self) -> tuple[str, tuple[int, ...], Channel | None]:
        """Give what it is about, without the size of the correction."""
        return self.conflict, self.joints, self.channel


class Conflict(ABC):
    """Describe one kind of conflict."""

    name: ClassVar[str]
    """Its name in documents."""
    title: ClassVar[str]
    """Its name for people."""
    doubtful_causes: ClassVar[frozenset[str]] = frozenset()
    """Causes that a log does not tell from what this conflict leaves when it is corrected."""

    @abstractmethod
    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """List the corrections that may remove it."""
