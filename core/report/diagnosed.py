"""Hold everything that a diagnosis job found out: the model before, the causes, the model after."""

from dataclasses import dataclass

from core.arrays import BaseParameters, Parameters
from core.diagnosis.diagnosis import Diagnosis
from core.diagnosis.reference import Reference
from core.extension.gain import JointGain
from core.report.identification import Identification
from core.simulation.multistep import Comparison
from core.validation.scores import JointScore


@dataclass(frozen=True, eq=False)
class Compared:
    """Hold how well a reference predicts the logs as it is.

    Attributes
    ----------
    base, standard
        Its base parameters, with what it leaves open filled in from the logs, and a robot that has them.
    """

    reference: Reference
    base: BaseParameters
    standard: Parameters
    fit: tuple[JointScore, ...]
    fit_total_percent: float
    validation: tuple[JointScore, ...]
    validation_total_percent: float

    @property
    def worse_than_nothing(self) -> tuple[int, ...]:
        """List the joints whose torque the reference misses by more than there is."""
        return tuple(one.joint for one in self.validation if one.rms_residual > one.rms_torque)


@dataclass(frozen=True, eq=False)
class Diagnosed:
    """Hold everything that a diagnosis job found out.

    Attributes
    ----------
    before
        The model as it was believed, identified from the logs.
    after
        The extended model identified again under the same constraints; None where nothing was found. Against
        a reference its base parameters stay as near to the reference's as those are known.
    gains
        Per joint, in torque, on held-out blocks; empty where nothing was found.
    motion
        Simulated motion of both models on held-out blocks; None where the models cannot be simulated.
    motion_note
        Why not, where they cannot.
    compared
        The reference on these logs; None where everything was identified anew.
    """

    before: Identification
    diagnosis: Diagnosis
    after: Identification | None
    gains: tuple[JointGain, ...]
    motion: Comparison | None
    motion_note: str
    compared: Compared | None = None
