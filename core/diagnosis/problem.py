"""State what a diagnosis is asked: a model, logs, and which blocks of them no fit may use."""

from dataclasses import dataclass

from ..arrays import BlockKey
from ..dynamics.model import DynamicModel
from ..identification.reference import Reference
from ..log.model import JointLog
from ..regressor.columns import ColumnPlan
from ..signals.dead_zone import DeadZone


@dataclass(frozen=True, eq=False)
class DiagnosisProblem:
    """State the question: what a model lacks, or what has changed since a reference."""

    plan: ColumnPlan
    """The model and its base columns."""
    logs: tuple[JointLog, ...]
    held_out: frozenset[BlockKey]
    blocks: int
    """Blocks of every log that no fit may see, and how many blocks a log has."""
    reference: Reference | None = None
    """What the logs are compared with; None to identify the model from the logs first."""
    zones: tuple[DeadZone, ...] = ()
    """Dead zones of torque channels, as far as they are known."""

    @property
    def model(self) -> DynamicModel:
        """Give the model."""
        return self.plan.model
