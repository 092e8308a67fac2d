"""Extend the model by the causes that were found: their terms become columns like all others.

The base parameters of the standard model keep their names and groupings; every parameter of a finding stands
for itself, because its evidence is what the standard columns do not span.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ..arrays import Indices
from ..diagnosis.result import Diagnosis, Finding
from ..dynamics.model import DynamicModel
from ..dynamics.term import Term
from ..reduction.base import BaseModel

_WIDE = 10.0
"""Width of the prior on a parameter that enters, over its value: so wide that the log decides."""


def corrections(diagnosis: Diagnosis) -> tuple[Term, ...]:
    """Give the terms of the findings whose gain on held-out rows is significant or verified."""
    return tuple(term for _, term in _entering_terms(diagnosis))


def _entering_terms(diagnosis: Diagnosis) -> Iterator[tuple[Finding, Term]]:
    for finding in diagnosis.findings:
        if finding.member is not None and enters(finding):
            yield finding, finding.member.term(diagnosis.dataset, diagnosis.operating_point)


def enters(finding: Finding) -> bool:
    """Tell whether a finding's gain on held-out rows is significant or verified."""
    return finding.verified or finding.gain is None or finding.gain.interval_95[0] > 0.0


def sizes(diagnosis: Diagnosis) -> dict[str, float]:
    """Give, by name, what counts as one unit of deviation of the parameters that enter the model."""
    return {
        f"{quantity.name}{quantity.joint}": _WIDE * abs(quantity.value)
        for finding in diagnosis.findings
        for quantity in finding.quantities
    }


def extended_base(base: BaseModel, terms: tuple[Term, ...]) -> BaseModel:
    """Append terms to a model and their parameters to its base parameters."""
    model: DynamicModel = base.model
    for term in terms:
        model = model.with_term(term)
    old, new = len(base.model.parameters), len(model.parameters)
    grouping = np.zeros((len(base.kept) + new - old, new))
    grouping[: len(base.kept), :old] = base.grouping
    grouping[len(base.kept) :, old:] = np.eye(new - old)
    return replace(base, model=model, kept=(*base.kept, *range(old, new)), grouping=grouping)


def as_verified(diagnosis: Diagnosis) -> Diagnosis:
    """Give the diagnosis with every finding verified, so that all of them enter."""
    findings = tuple(replace(finding, verified=True) for finding in diagnosis.findings)
    return replace(diagnosis, findings=findings)


def global_indices(diagnosis: Diagnosis, base: BaseModel) -> Indices:
    """Give the indices of an extended model's base parameters in the model with all findings."""
    indices = list(range(len(base.kept)))
    members = (finding for finding in diagnosis.findings if finding.member is not None)
    stop = len(indices)
    for finding, (_, term) in zip(members, _entering_terms(as_verified(diagnosis)), strict=True):
        start, stop = stop, stop + len(term.parameters(base.model.robot))
        if enters(finding):
            indices += range(start, stop)
    return np.array(indices)


def input_note(diagnosis: Diagnosis) -> str:
    """Say which findings are inputs to a simulation of the extended model, and how; nothing where none is."""
    joined = list(_entering_terms(diagnosis))
    past = [_label(finding) for finding, term in joined if term.has_memory and not term.channel]
    channel = [_label(finding) for finding, term in joined if term.channel]
    parts = [f"the torque of {' and '.join(past)} is the one along the measured motion"] if past else []
    if channel:
        parts.append(
            f"{' and '.join(channel)} is taken out of the measured torque before it drives the robot"
        )
    return "; ".join(parts)


def _label(finding: Finding) -> str:
    if len(finding.joints) != 1:
        return finding.cause
    return f"{finding.cause} at joint {finding.joints[0]}"
