"""Claim no more than is allowed beside a model that only impossible bodies would let follow the log."""

from dataclasses import replace

from ..diagnosis.checks.reservations import SetupDoubts, with_reservations
from ..identification.contradictions import has_impossible_joint
from .result import Extension


def reserved(extension: Extension) -> Extension:
    """Limit what is found where the last model, extended or not, fails by its consistency."""
    if not has_impossible_joint(extension.after or extension.before):
        return extension
    found = with_reservations(extension.diagnosis, SetupDoubts(is_open=True), doubted=True)
    return replace(extension, diagnosis=found)
