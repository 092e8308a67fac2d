"""Read a result document from a file."""

import json
from pathlib import Path
from typing import Any

from core.errors import OptionError

RESULT_HELP = "A result document (a file, as --out or --json wrote it); with --url the id of a job."
NEEDED = frozenset({"schema_version", "kind", "robot", "base_parameters", "standard_parameters"})


def read_result(given: str) -> dict[str, Any]:
    """Read a result document.

    Raises
    ------
    OptionError
        If the file is not there, or holds something else.
    """
    try:
        document = json.loads(Path(given).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise OptionError(
            f"{given} is not a result that can be read",
            evidence={"reason": getattr(error, "strerror", None) or str(error)},
            remedy="name a file that `veritorque identify --out` wrote, or give --url with the id of a job",
        ) from error
    missing = NEEDED - document.keys() if isinstance(document, dict) else NEEDED
    if missing:
        raise OptionError(
            f"{given} is not a result document",
            evidence={"missing": sorted(missing)},
            remedy="name a file that `veritorque identify --out` wrote",
        )
    return dict(document)
