"""Keep answers as files, one JSON document each."""

import gzip
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

ENDING = ".json.gz"


def keep(folder: Path, name: str, document: Mapping[str, Any]) -> None:
    """Write an answer; the same answer gives the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    text = json.dumps(document, indent=1, ensure_ascii=False)
    (folder / f"{name}{ENDING}").write_bytes(gzip.compress(text.encode(), mtime=0))


def kept(folder: Path, name: str) -> dict[str, Any] | None:
    """Read an answer; None where none was kept."""
    file = folder / f"{name}{ENDING}"
    return json.loads(gzip.decompress(file.read_bytes())) if file.exists() else None


def names(folder: Path) -> list[str]:
    """List what is kept."""
    return sorted(one.name.removesuffix(ENDING) for one in folder.glob(f"*{ENDING}"))
