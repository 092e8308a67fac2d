"""Test whether a table of Denavit-Hartenberg parameters was written in another convention."""

from collections.abc import Iterator
from dataclasses import replace

from ...robot.model import Link, RobotModel
from ...robot.modified_dh import ModifiedDHRow
from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..trial import Trials


class Convention(Conflict):
    """Read the table as standard DH, or with its two lengths exchanged."""

    name = "convention"
    title = "Convention of the table"

    def hypotheses(self, setup: Setup, _trials: Trials) -> Iterator[Hypothesis]:
        """Read a plain chain's table in the other usual ways."""
        known = _rows_of_a_chain(setup.robot)
        if not known:
            return
        readings = {
            "written in standard, not in modified Denavit-Hartenberg parameters": _standard(known),
            "written with the lengths d and r exchanged": [replace(row, d=row.r, r=row.d) for row in known],
        }
        for words, other in readings.items():
            if other != known:
                links = tuple(_placed(link, row) for link, row in zip(setup.robot.links, other, strict=True))
                yield Hypothesis(
                    self.name,
                    (),
                    None,
                    setup.with_links(links),
                    f"the table is {words}",
                    "use the table of the corrected description",
                )


def _rows_of_a_chain(robot: RobotModel) -> list[ModifiedDHRow]:
    """Give the table of a plain chain; nothing of a tree, or where a link has no row."""
    chain = all(link.antecedent == place for place, link in enumerate(robot.links))
    known = [link.row for link in robot.links if link.row is not None]
    return known if chain and len(known) == len(robot.links) else []


def _standard(rows: list[ModifiedDHRow]) -> list[ModifiedDHRow]:
    """Write standard rows as modified ones: twist and length of a row belong to the next joint.

    Source: Khalil & Dombre (2002), ch. 3; Craig, Introduction to Robotics (2005), ch. 3.
    """
    before = [ModifiedDHRow(0.0, 0.0, 0.0), *rows[:-1]]
    return [
        replace(row, alpha=previous.alpha, d=previous.d) for row, previous in zip(rows, before, strict=True)
    ]


def _placed(link: Link, row: ModifiedDHRow) -> Link:
    rotation, translation = row.placement()
    return replace(link, rotation=rotation, translation=translation, row=row)
