"""Test whether a length of the table is wrong by more than a small correction, by its profile likelihood."""

from collections.abc import Iterator

import numpy as np
from scipy.optimize import minimize_scalar

from ...dynamics.terms.kinematic_error import EntryName, with_entry
from ...robot.model import Link
from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..thresholds import LENGTH
from ..trial import Trials

ENTRIES: tuple[EntryName, ...] = ("d", "r")
_GENERAL = 0.0731
"""A change of lengths, m per number of the joint, after which none is zero."""


class LinkLength(Conflict):
    """Change one length of one row, with all parameters fitted again."""

    name = "link_length"
    title = "Length of a link"

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Give the likeliest error of every length that the logs show."""
        for place, link in enumerate(setup.robot.links):
            for entry in ENTRIES:
                if not _is_shown(link, entry):
                    continue
                change = _likeliest(setup, trials, place, entry)
                if abs(change) < LENGTH.least:
                    continue
                before, after = _length(link, entry), _length(link, entry) + change
                yield Hypothesis(
                    self.name,
                    (link.joint,),
                    None,
                    _changed(setup, trials, place, entry, change),
                    f"the length {entry} of joint {link.joint} is {after:.3g} m, not {before:.3g} m",
                    f"describe joint {link.joint} with {entry} = {after:.4g} m",
                )


def _is_shown(link: Link, entry: EntryName) -> bool:
    """Tell whether a length may show: not on the first link, and not along the joint's own stroke."""
    if link.row is None or link.antecedent == 0:
        return False
    return entry == "d" or link.kind == "revolute"


def _likeliest(setup: Setup, trials: Trials, place: int, entry: EntryName) -> float:
    """Minimise what least squares leaves over the error of a length, coarsely and then finely."""

    def links(change: float) -> tuple[Link, ...]:
        return _changed(setup, trials, place, entry, change).robot.links

    bound = trials.along_length(setup, _general(setup, trials), links)
    scores = bound(np.array(LENGTH.coarse))
    best = int(np.argmin(scores))
    present = scores[LENGTH.coarse.index(0.0)]
    if present - scores[best] < LENGTH.promising:
        return 0.0
    around = LENGTH.coarse[max(best - 1, 0)], LENGTH.coarse[min(best + 1, len(LENGTH.coarse) - 1)]

    def lost(change: float) -> float:
        return float(bound(np.array(change)))

    found = minimize_scalar(lost, bounds=around, method="bounded", options={"xatol": LENGTH.tolerance})
    return float(found.x)


def _general(setup: Setup, trials: Trials) -> tuple[Link, ...]:
    """Give the links with all lengths changed that may show, so that none is zero."""

    def general() -> tuple[Link, ...]:
        robot = setup.robot
        shown = ((link.joint, entry) for link in robot.links for entry in ENTRIES if _is_shown(link, entry))
        for joint, entry in shown:
            robot = with_entry(robot, joint, entry, _GENERAL * joint)
        return robot.links

    return trials.links(setup, ("general",), general)


def _changed(setup: Setup, trials: Trials, place: int, entry: EntryName, change: float) -> Setup:
    if change == 0.0:
        return setup

    def changed() -> tuple[Link, ...]:
        return with_entry(setup.robot, setup.robot.links[place].joint, entry, change).links

    return setup.with_links(trials.links(setup, (place, entry, change), changed))


def _length(link: Link, entry: EntryName) -> float:
    return float(getattr(link.row, entry))
