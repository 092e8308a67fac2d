"""Write the reader's list of problems from the table of kinds, so that the document cannot drift.

`make reference` writes docs/problems.md, and a test compares the two.
"""

import sys

from ..problems import KINDS, MEDIA_TYPE, URN

OPENING = f"""\
# Problems

Written by `make reference` from `app/problems.py`; change that, not this page.

Every failure is a document of type `{MEDIA_TYPE}` (RFC 9457). `type` is `{URN}` and the kind, and never
changes its meaning: branch on it, never on the words. Three fields are ours: `cause` says what is wrong,
`evidence` holds the numbers and JSON pointers that show it, `remedy` says what to change. [What they
look like](http.md#when-it-fails).

| kind | status | title |
|---|---|---|
"""


def guide() -> str:
    """Write the document in Markdown, the kinds by their status."""
    ordered = sorted(KINDS.items(), key=lambda item: item[1][0])
    return OPENING + "".join(f"| `{kind}` | {status} | {title} |\n" for kind, (status, title) in ordered)


if __name__ == "__main__":
    sys.stdout.write(guide())
