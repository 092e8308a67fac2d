"""Hold everything that a diagnosis job found out: the model before, the causes, the model after."""

from dataclasses import dataclass

from ..diagnosis.result import Diagnosis
from ..identification.reference_score import ReferenceScore
from ..identification.result import Identification
from ..simulation.multistep import Comparison
from .gain import JointGain


@dataclass(frozen=True, eq=False)
class Extension:
    """Hold everything that a diagnosis job found out."""

    before: Identification
    """The model as it was stated, identified from the logs."""
    diagnosis: Diagnosis
    after: Identification | None
    """The extended model identified again under the same constraints; None where nothing was found. Against a
    reference its base parameters stay as near to the reference's as those are known."""
    gains: tuple[JointGain, ...]
    """Per joint, in torque, on held-out blocks; empty where nothing was found."""
    motion: Comparison | None
    """Simulated motion of both models on held-out blocks; None where the models cannot be simulated."""
    motion_note: str
    """Which findings are inputs to the simulation; or why there is none."""
    compared: ReferenceScore | None = None
    """The reference on these logs; None where everything was identified anew."""
