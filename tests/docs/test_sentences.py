"""The documents are written in short sentences: at most 2 % of them have more than 35 words.

Code, formulas, tables, headings and comments are not prose and are not counted. A code span or an inline
formula counts as one word, a link as the words of its text. Pages that the code writes are held to the rule
as well.
"""

import re
from dataclasses import dataclass
from pathlib import Path

from tests.docs.blocks import PAGES, ROOT

LONGEST_WORDS = 35
"""A sentence with more words than this is long; most should stay below 25."""
LONG_SHARE = 0.02
"""Share of long sentences that is tolerated: now and then one is the clearest way to say it."""
WORST = 10
"""Number of long sentences that a failure prints."""
_NOT_PROSE = re.compile(
    r"^```.*?^```$"  # fenced blocks
    r"|^\$\$.*?\$\$$"  # formulas that stand alone
    r"|<!--.*?-->"
    r"|^\|.*?$"  # rows of tables
    r"|^#+ .*?$",  # headings
    re.DOTALL | re.MULTILINE,
)
_BLOCK = re.compile(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )")
_MARKER = re.compile(r"^\s*(?:[-*]|\d+\.) ")
_ONE_WORD = re.compile(r"`[^`]+`|\$[^$]+\$")
_KEPT = "\u2423"
"""A space inside a code span or formula, where no sentence ends."""
_LINK = re.compile(r"!?\[([^\]]*)\]\([^)\s]*\)")
_END = re.compile(r"(?<![ (]e\.g)(?<![ (]i\.e)(?<! vs)(?<! al)(?<!Fig)([.!?][)\]*\"”']*)\s+(?=[^a-z\s])")


@dataclass(frozen=True)
class Sentence:
    """Hold one sentence, the page on which it stands and the number of its words."""

    page: Path
    text: str
    words: int

    def __str__(self) -> str:
        return f"{self.page.relative_to(ROOT)}: {self.words} words: {self.text}"


def split_sentences(text: str) -> list[str]:
    """Split the prose of a page into sentences."""
    prose = _NOT_PROSE.sub("\n\n", text)
    blocks = (" ".join(_MARKER.sub("", block).split()) for block in _BLOCK.split(prose))
    whole = (_ONE_WORD.sub(lambda span: span[0].replace(" ", _KEPT), block) for block in blocks)
    split = (_END.sub(r"\1\n", block).split("\n") for block in whole)
    return [sentence.replace(_KEPT, " ") for found in split for sentence in found if sentence]


def count_words(sentence: str) -> int:
    """Count what a reader sees as words; a dash or an arrow is none."""
    seen = _ONE_WORD.sub("code", _LINK.sub(r"\1", sentence))
    return sum(any(letter.isalnum() for letter in token) for token in seen.split())


def sentences_of(page: Path) -> list[Sentence]:
    """List the sentences of a page."""
    found = split_sentences(page.read_text(encoding="utf-8"))
    return [Sentence(page, text, count_words(text)) for text in found]


def long_ones(sentences: list[Sentence]) -> list[Sentence]:
    """Give the sentences with too many words, the longest first."""
    found = [sentence for sentence in sentences if sentence.words > LONGEST_WORDS]
    return sorted(found, key=lambda sentence: -sentence.words)


def test_few_sentences_of_the_documents_are_long():
    sentences = [sentence for page in PAGES for sentence in sentences_of(page)]
    found = long_ones(sentences)
    share = len(found) / len(sentences)
    worst = "\n".join(map(str, found[:WORST]))
    count = f"{len(found)} of {len(sentences)} sentences have more than {LONGEST_WORDS} words"
    assert share <= LONG_SHARE, f"{count}; the worst:\n{worst}"


def test_code_tables_and_headings_are_not_sentences():
    text = "# A heading. Of two\n\n| a table. | Of two. |\n\n```bash\nmake test. Then\n```\n\n$$\nx. Y\n$$\n"
    assert split_sentences(text) == []


def test_sentences_end_at_full_stops_and_at_the_ends_of_paragraphs_and_items():
    text = "One. Two (or three)? Four is 4.5\nor `a. B` e.g. Six\n\n- Seven\n- Eight: nine; ten\n1. Eleven\n"
    assert split_sentences(text) == [
        "One.",
        "Two (or three)?",
        "Four is 4.5 or `a. B` e.g. Six",
        "Seven",
        "Eight: nine; ten",
        "Eleven",
    ]


def test_a_link_counts_as_its_text_and_a_code_span_as_one_word():
    assert count_words("See [the two words](logs.md#a-b) of `make bench N=1`: $a + b$ - done") == 8


def test_a_long_sentence_is_noticed(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(f"Short. Now {'word ' * LONGEST_WORDS}ends here.\n")
    assert [sentence.words for sentence in long_ones(sentences_of(page))] == [LONGEST_WORDS + 3]
