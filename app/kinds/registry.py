"""List the kinds of job.

A new kind is one file beside this one, which admits, computes and names the schema of its document, and one
line here. A page or a table of its own are files of `pages` and `terminal`.
"""

from collections.abc import Mapping
from functools import reduce
from operator import or_
from typing import Any

from ...core.errors import OptionError
from .audit import Audit
from .check import Check
from .compare import Compare
from .diagnose import Diagnose
from .identify import Identify
from .joint_model import JointModel
from .kind import JobKind

_LISTED: tuple[JobKind[Any], ...] = (Identify(), Diagnose(), Check(), Audit(), Compare(), JointModel())
KINDS: Mapping[str, JobKind[Any]] = {kind.name: kind for kind in _LISTED}


def result_document() -> Any:  # noqa: ANN401  # a union, which has no type of its own
    """Give the model of a result document of any kind."""
    return reduce(or_, (kind.result for kind in KINDS.values()))


def kind_of(name: str) -> JobKind[Any]:
    """Find a kind of job by its name.

    Raises
    ------
    OptionError
        If there is no such kind.
    """
    if name not in KINDS:
        raise OptionError(
            f"there is no job of kind {name}",
            evidence={"given": name, "known": list(KINDS)},
            remedy="ask for one of the known kinds",
        )
    return KINDS[name]
