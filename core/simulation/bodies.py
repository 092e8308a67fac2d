"""Say which bodies a robot carries, and from when on: one that is taken up or lost belongs to the masses.

A body that joins the links at some instant changes the mass matrix. Added as a torque of the last known
acceleration it would diverge wherever it is heavier than what it hangs on. Source: Khalil & Dombre (2002),
ch. 12.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import LinkTable, Parameters, Samples
from ..dynamics.model import DynamicModel
from ..dynamics.term import Term
from ..dynamics.terms.link_parameters import LinkChange
from ..dynamics.terms.payload_change import Payload
from ..dynamics.terms.rigid_body import RigidBody
from .inverse import Bodies, bodies_of


@dataclass(frozen=True, eq=False)
class Phases:
    """Hold a robot's bodies over time, as the kernels need them."""

    begins: np.ndarray
    """Rising instants, s, from each of which on other bodies are there; the first is minus infinity."""
    bodies: tuple[Bodies, ...]
    """As many."""

    def at(self, time: Samples) -> np.ndarray:
        """Give the number of the phase at every instant (s)."""
        return np.searchsorted(self.begins, time, side="right") - 1


def is_body(term: Term) -> bool:
    """Tell whether a term stands for moving masses and for nothing else."""
    return isinstance(term, RigidBody | LinkChange | Payload)


def phases_of(model: DynamicModel, parameters: Parameters) -> Phases:
    """Add up what the links are, and what joins them at which instant."""
    always, joining = np.zeros((len(model.robot.links), 10)), list[tuple[float, LinkTable]]()
    for term, values in model.split(parameters):
        if isinstance(term, RigidBody):
            always += values.reshape(-1, 10)
        elif isinstance(term, LinkChange):
            always[term.link - 1] += values
        elif isinstance(term, Payload):
            body = np.zeros_like(always)
            body[term.link - 1] = values
            joining.append((term.begin, body))
    begins = np.array(sorted({-np.inf, *(begin for begin, _ in joining)}))
    return Phases(begins, tuple(bodies_of(model.robot, _links_at(now, always, joining)) for now in begins))


def _links_at(now: float, always: LinkTable, joining: list[tuple[float, LinkTable]]) -> LinkTable:
    return sum((body for begin, body in joining if begin <= now), always)
