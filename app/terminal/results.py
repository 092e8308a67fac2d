"""Read a result document from a file."""

import json
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ...core.errors import OptionError

RESULT_HELP = "A result document (a file, as --out or --json wrote it); with --url the id of a job."


def read_result(given: str) -> dict[str, Any]:
    """Read a result document.

    Raises
    ------
    OptionError
        If the file is not there, or holds something else.
    """
    from ..schemas.results import ResultDocument

    try:
        content = Path(given).read_bytes()
        document: dict[str, Any] = json.loads(content)
    except (OSError, ValueError) as error:
        raise OptionError(
            f"{given} cannot be read as a result",
            evidence={"reason": getattr(error, "strerror", None) or str(error)},
            remedy="name a file written by `veritorque identify --out`, or give --url with the id of a job",
        ) from error
    try:
        ResultDocument.model_validate_json(content)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        raise OptionError(
            f"{given} is not a result document",
            evidence={"at": "/".join(map(str, first["loc"])) or "the whole file", "reason": first["msg"]},
            remedy="name an unchanged file written by `veritorque identify --out`",
        ) from error
    return document
