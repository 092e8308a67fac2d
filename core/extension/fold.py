"""Put what only changes parameters that the model has where it belongs: into those parameters.

A payload that was there throughout, another friction or another link joins a model as a term of its own, so
that its size has a deviation of its own. Simulated, or given to others, it is simply another robot.
"""

from dataclasses import replace

import numpy as np

from ..arrays import Parameters, Weights
from ..dynamics.model import DynamicModel
from ..dynamics.term import Term


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
