"""Say of a refusal of too few rows that gaps in the logs are behind it."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from ..errors import ExcitationError, LogError, OptionError
from .model import JointLog

REMEDY = (
    "record every row, or a motion that is slower beside the rows that are kept: gaps up to a tenth of the "
    "motion's period and five mean steps are bridged"
)


@contextmanager
def naming_gaps(logs: Sequence[JointLog]) -> Iterator[None]:
    """Add to a refusal the gaps that cut the logs, where any do."""
    try:
        yield
    except (ExcitationError, LogError, OptionError) as error:
        gaps = _gaps(logs)
        if not gaps:
            raise
        stretches = sum(len(log.segments) for log in logs)
        raise type(error)(
            f"{error.cause}: rows are missing, which cuts the log into {stretches} stretches",
            evidence={**error.evidence, "gaps": gaps},
            remedy=f"{REMEDY}; otherwise {error.remedy}",
        ) from None


def _gaps(logs: Sequence[JointLog]) -> dict[str, str]:
    """Describe the gaps of every log that they cut."""
    cut = [log for log in logs if len(log.segments) > 1]
    return {log.name: defect.statement for log in cut for defect in log.defects if defect.kind == "gap"}
