"""Fit one model to measured motion, and judge the fit by every measure there is."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from ..estimate.constraints import Prior, default_prior
from ..estimate.estimate import Estimate, estimate
from ..estimate.feasibility import active_constraints, feasibility
from ..estimate.gaussian_prior import GaussianPrior
from ..estimate.measured import Measured, weighted_system
from ..estimate.system import System
from ..log.model import JointLog
from ..numerics.block_bootstrap import block_draws
from ..precision.bootstrap import bootstrap
from ..precision.covariance import assess
from ..precision.essential import essential_parameters
from ..reduction.base import BaseModel
from ..regressor.observe import Observation, torque_scales
from ..validation.excitation import excitation
from ..validation.mass_matrix import check_mass_matrix, pseudo_inertia_eigenvalues, workspace
from ..validation.scores import scores, total_percent
from .options import IdentifyOptions
from .result import Identification

Progress = Callable[[str, float], None]


@dataclass(frozen=True, eq=False)
class Fitting:
    """Hold a model to be fitted: the data, its base parameters, and what is known otherwise.

    Attributes
    ----------
    sizes
        By name, what counts as one unit of deviation of parameters that the standard model has not.
    prior
        Normal prior of the base parameters; None for none.
    """

    data: Measured
    base: BaseModel
    sizes: Mapping[str, float] = field(default_factory=dict)
    prior: GaussianPrior | None = None


@dataclass(frozen=True, eq=False)
class Fitted:
    """Hold an estimate and the equations it was made from, rows weighed as the fit weighed them (`used`)."""

    observation: Observation
    used: Observation
    system: System
    prior: Prior
    estimate: Estimate


def fitted(
    options: IdentifyOptions, fitting: Fitting, tell: Progress, observation: Observation | None = None
) -> Fitted:
    """Fit one model to the data, or to what was observed of them already."""
    data, base = fitting.data, fitting.base
    if observation is None:
        observation = data.observed(lambda done: tell("observe", 0.3 + 0.3 * done))
    tell("estimate", 0.6)
    used, system = weighted_system(data, observation, options.estimate)
    system = _informed(system, fitting.prior)
    parts = data.parts(observation)[0]
    prior = default_prior(base.model, torque_scales(observation, parts), fitting.sizes)
    return Fitted(observation, used, system, prior, estimate(base, system, prior, options.estimate))


def identified(
    logs: tuple[JointLog, ...],
    options: IdentifyOptions,
    fitting: Fitting,
    tell: Progress,
    found: Fitted | None = None,
) -> Identification:
    """Fit one model, unless that was done already, and judge it."""
    data, base, model = fitting.data, fitting.base, fitting.base.model
    found = fitted(options, fitting, tell) if found is None else found
    observation, used, system, prior = found.observation, found.used, found.system, found.prior
    answer, parts = found.estimate, data.parts(observation)
    tell("assess", 0.7)
    known = None if fitting.prior is None else fitting.prior.rows
    precision = assess(system, used.memory, used.columns_of, answer.base, known=known)
    essential = essential_parameters(system, precision)
    if options.essential:
        answer = estimate(base, system, prior, options.estimate, essential=essential.kept)
    blocks = tuple(used.blocks[place] for place in parts[0])
    draws = bootstrap(
        system,
        blocks,
        used.columns_of,
        lambda drawn: (
            estimate(
                base,
                _informed(drawn, fitting.prior),
                prior,
                options.estimate,
                essential=essential.kept if options.essential else None,
            ).base
        ),
        block_draws(len(blocks), options.bootstrap.draws, options.bootstrap.seed),
    )
    tell("validate", 0.9)
    return Identification(
        logs=logs,
        motions=data.motions,
        base=base,
        observation=observation,
        estimate=answer,
        precision=precision,
        essential=essential,
        draws=draws,
        fit=scores(observation, parts[0], answer.base),
        fit_total_percent=total_percent(observation, parts[0], answer.base),
        validation=scores(observation, parts[1], answer.base) if parts[1] else (),
        validation_total_percent=total_percent(observation, parts[1], answer.base) if parts[1] else 0.0,
        excitation=excitation(system.triangle),
        unconstrained_feasibility=feasibility(base, answer.unconstrained, prior),
        estimate_feasibility=feasibility(base, base.base_of(answer.standard), prior),
        pseudo_inertia_eigenvalues=pseudo_inertia_eigenvalues(model, answer.standard),
        active_constraints=active_constraints(model, answer.standard, prior, options.estimate.bounds),
        trajectory=check_mass_matrix(model, answer.standard, observation.positions),
        workspace=check_mass_matrix(model, answer.standard, workspace(model.robot)),
        widths=next((term.widths for term in model.terms if term.name == "coulomb"), ()),  # type: ignore[attr-defined]  # Coulomb friction alone has them
        seed=options.bootstrap.seed,
        held_out=data.held_out,
    )


def _informed(system: System, prior: GaussianPrior | None) -> System:
    return system if prior is None else system.informed(prior.rows, prior.target)
