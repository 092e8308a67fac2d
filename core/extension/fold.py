"""Put what only changes parameters that the model has where it belongs: into those parameters.

A payload that was there throughout, another friction or another link joins a model as a term of its own, so
that its size has a deviation of its own. Simulated, or given to others, it is simply another robot.
"""

from dataclasses import replace

import numpy as np

from ..arrays import Parameters, Weights
from ..dynamics.model import DynamicModel
from ..dynamics.term import Term
from ..identification.result import Identification


def folded(found: Identification) -> Identification:
    """Give an identification whose parameters include what its terms change of them.

    Notes
    -----
    With T the identity plus what each term's parameter adds to the base parameters, base values become
    T chi, and information and meat T^-T A T^-1. The terms' own parameters stay beside them.
    """
    base, estimate, precision = found.base, found.estimate, found.precision
    whole = np.eye(len(base.model.parameters))
    column_of = {parameter.name: column for column, parameter in enumerate(base.model.parameters)}
    for own, names in parts_of(base.model).items():
        for name in names:
            whole[column_of[name], column_of[own]] += 1.0
    if np.array_equal(whole, np.eye(len(whole))):
        return found
    kept = list(base.kept)
    added = np.asarray(base.grouping @ (whole[:, kept] - np.eye(len(whole))[:, kept])) + np.eye(len(kept))
    back = np.asarray(2.0 * np.eye(len(kept)) - added)  # what is added is not changed itself
    system = estimate.system
    return replace(
        found,
        estimate=replace(
            estimate,
            base=added @ estimate.base,
            unconstrained=added @ estimate.unconstrained,
            standard=whole @ estimate.standard,
            system=replace(system, triangle=system.triangle @ back),
        ),
        precision=replace(
            precision, information=back.T @ precision.information @ back, meat=back.T @ precision.meat @ back
        ),
        draws=found.draws @ added.T if len(found.draws) else found.draws,
    )


def parts_of(model: DynamicModel) -> dict[str, list[str]]:
    """Give, per parameter of a term that changes others, the parameter that it is added to."""
    known = {parameter.name for parameter in model.parameters}
    return {
        parameter.name: [name]
        for term in model.terms
        if all(name in known for name in getattr(term, "changes", ()))
        for parameter, name in zip(term.parameters(model.robot), getattr(term, "changes", ()), strict=False)
    }


def fold(model: DynamicModel, standard: Parameters) -> tuple[DynamicModel, Weights]:
    """Add the terms' parameters to those they change, and leave the terms out.

    Terms that change parameters which the model does not have stay.
    """
    column_of = {parameter.name: column for column, parameter in enumerate(model.parameters)}
    values, start = np.array(standard), 0
    kept: list[int] = []
    terms: list[Term] = []
    for term in model.terms:
        stop = start + len(term.parameters(model.robot))
        changed = getattr(term, "changes", ())
        if changed and all(name in column_of for name in changed):
            values[[column_of[name] for name in changed]] += values[start:stop]
        else:
            terms.append(term)
            kept += range(start, stop)
        start = stop
    return replace(model, terms=tuple(terms)), values[kept]
