"""Hold everything that an identification found out, chapter by chapter, for the pages that tell it."""

from dataclasses import dataclass

from ..arrays import BlockKey, JointVector, Matrix
from ..estimate.estimate import Estimate
from ..estimate.feasibility import Feasibility
from ..estimate.kalman.innovations import Innovations, Track
from ..estimate.simulator import SimulationSetup
from ..log.model import JointLog
from ..precision.attenuation import Attenuation
from ..precision.endogeneity import Endogeneity
from ..precision.essential import Essential
from ..precision.inference import Inference
from ..reduction.base import BaseModel
from ..regressor.observe import Observation
from ..robot.extent import Extent
from ..signals.condition import Motion
from ..validation.excitation import ExcitationScore
from ..validation.mass_matrix import MassMatrixCheck
from ..validation.scores import JointScore
from .choice import Choice
from .convergence import Convergence
from .flexible import FlexibleJoint


@dataclass(frozen=True, eq=False)
class Identification:
    """Hold everything that an identification found out, chapter by chapter."""

    logs: tuple[JointLog, ...]
    motions: tuple[Motion, ...]
    base: BaseModel
    observation: Observation
    estimate: Estimate
    precision: Inference
    essential: Essential
    draws: Matrix
    fit: tuple[JointScore, ...]
    fit_total_percent: float
    validation: tuple[JointScore, ...]
    validation_total_percent: float
    reversals_percent: float | None
    """Held-out error beside reversals, which is not in the errors above; None without such rows."""
    reversal_weights: JointVector
    """Per joint, the weight in the fit of the rows beside its reversals."""
    excitation: ExcitationScore
    unconstrained_feasibility: Feasibility
    estimate_feasibility: Feasibility
    unconstrained_plausible: bool | None
    extents: tuple[Extent | None, ...]
    pseudo_inertia_eigenvalues: tuple[float, ...]
    active_constraints: tuple[str, ...]
    trajectory: MassMatrixCheck
    workspace: MassMatrixCheck
    widths: tuple[float, ...]
    seed: int
    held_out: frozenset[BlockKey]
    estimator: str
    """Its name in the registry."""
    convergence: Convergence
    """How it ended, where it takes more than one step."""
    simulation: SimulationSetup
    """How the logs were simulated, or which other periods stood beside them, where it iterates."""
    start_percent: float | None
    """Error of the least squares that an iteration began at, like `judged_percent`; None without one."""
    position_rms: JointVector | None
    """RMS of that motion less the measured positions, rad or m; None where there is none."""
    innovations: Innovations | None
    """What a Kalman filter says of itself; None where nothing was filtered."""
    track: Track | None
    """The parameters over time; None where they were not followed."""
    endogeneity: Endogeneity | None
    """What instruments tell of errors in the measured motion; None where there are none."""
    flexible_joints: tuple[FlexibleJoint, ...]
    """What is known of springs between motors and links; none where all joints are rigid."""
    choice: Choice | None
    """Why this estimator, where the choice was left open."""
    attenuation: Attenuation
    """What noise of positions makes of the inertias of least squares."""

    @property
    def judged_percent(self) -> float:
        """Give the error on held-out data; where none was held out, on what was fitted."""
        return self.validation_total_percent if self.validation else self.fit_total_percent

    @property
    def feasible(self) -> bool:
        """Tell whether the robot is consistent; its mass matrix counts where links are modelled.

        Where the margin of its base parameters is not known, its own bodies tell.
        """
        consistent = self.estimate_feasibility.feasible
        if consistent is None:
            consistent = all(value > 0.0 for value in self.pseudo_inertia_eigenvalues)
        if not self.pseudo_inertia_eigenvalues:
            return consistent
        return consistent and self.trajectory.positive and self.workspace.positive
