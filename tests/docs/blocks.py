"""Take the fenced blocks out of the documents, with what a comment right above says about running them.

`<!-- not run: REASON -->` says why a block cannot run here, `<!-- as in docs/operating.md -->` that the same
runs there, `<!-- answers 422 -->` that its last request is meant to be refused, `<!-- goes on; it is up when:
COMMAND -->` that its last line runs until it is stopped. A reader of the page sees none of them.
"""

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = [
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "docker/README.md")),
    *sorted((ROOT / "docs").glob("*.md")),
]
GOES_ON = "goes on; it is up when: "
_FENCE = re.compile(
    r"(?:^<!-- (?P<mark>[^\n]+) -->\n)?^```(?P<language>\w*)\n(?P<body>.*?)^```$", re.DOTALL | re.MULTILINE
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
    def elsewhere(self) -> str:
        """Name the page where the same runs; empty where it runs here."""
        return self.mark.removeprefix("as in ") if self.mark.startswith("as in ") else ""

    @property
    def is_up(self) -> str:
        """Give the command that succeeds once its last line does what it is for; empty where that ends."""
        return self.mark.removeprefix(GOES_ON) if self.mark.startswith(GOES_ON) else ""

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
