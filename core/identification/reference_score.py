"""Score a reference on logs as it is, so that a reader sees what the given simulation gets wrong."""

from dataclasses import dataclass, replace

from ..arrays import BaseParameters, Parameters
from ..estimate.estimate import nearest
from ..validation.scores import JointScore, scores, total_percent
from .reference import Reference
from .result import Identification


@dataclass(frozen=True, eq=False)
class ReferenceScore:
    """Hold how well a reference predicts the logs as it is."""

    reference: Reference
    base: BaseParameters
    standard: Parameters
    """Its base parameters, with what it leaves open filled in from the logs, and a robot that has them."""
    fit: tuple[JointScore, ...]
    fit_total_percent: float
    validation: tuple[JointScore, ...]
    validation_total_percent: float

    @property
    def worse_than_nothing(self) -> tuple[int, ...]:
        """List the joints whose torque the reference misses by more than there is."""
        return tuple(score.joint for score in self.validation if score.rms_residual > score.rms_torque)


def score_reference(
    reference: Reference, found: Identification, parts: tuple[tuple[int, ...], ...]
) -> ReferenceScore:
    """Score a reference on the fitted and the held-out blocks of logs that were identified anew.

    Parameters
    ----------
    parts
        Places of the fitted and of the held-out blocks.
    """
    observation = found.observation
    base = reference.completed(found.estimate.system)
    standard = nearest(found.base, base, replace(found.estimate.prior, centre=reference.standard))
    fit, held = ((scores(observation, part, base), total_percent(observation, part, base)) for part in parts)
    return ReferenceScore(reference, base, standard, *fit, *held)
