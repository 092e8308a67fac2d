"""Take the fenced blocks out of the documents, with what a comment right above says about running them.

`<!-- not run: REASON -->` says why a block cannot run here, `<!-- answers 422 -->` that its last request is
meant to be refused. A reader of the page sees neither.
"""

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = [
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "docker/README.md")),
    *sorted((ROOT / "docs").glob("*.md")),
]
_FENCE = re.compile(
    r"(?:^<!-- (?P<mark>.+) -->\n)?^```(?P<language>\w*)\n(?P<body>.*?)^```$", re.DOTALL | re.MULTILINE
)


@dataclass(frozen=True)
class Block:
    """Hold one fenced block: where it stands, its language, its text, and the remark above it."""

    page: Path
    line: int
    language: str
    body: str
    mark: str

    @property
    def reason(self) -> str:
        """Say why it is not run; empty where it is."""
        return self.mark.removeprefix("not run: ") if self.mark.startswith("not run: ") else ""

    @property
    def status(self) -> int | None:
        """Give the status with which its last request is to be refused, if it is."""
        return int(self.mark.removeprefix("answers ")) if self.mark.startswith("answers ") else None

    def __str__(self) -> str:
        return f"{self.page.relative_to(ROOT)}:{self.line}"


def blocks_of(page: Path) -> list[Block]:
    """List the blocks of a page in their order."""
    text = page.read_text(encoding="utf-8")
    return [
        Block(page, text.count("\n", 0, one.start()) + 1, one["language"], one["body"], one["mark"] or "")
        for one in _FENCE.finditer(text)
    ]


BLOCKS = [block for page in PAGES for block in blocks_of(page)]
