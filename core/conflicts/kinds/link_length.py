"""Test whether a length of the description is off by more than a small correction, by profile likelihood.

A table has two lengths per row. Where the placement itself was given, as by a URDF, there are three.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize_scalar

from ...robot.model import Link
from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..thresholds import LENGTH
from ..trial import Trials

ROW, PLACE = ("d", "r"), ("x", "y", "z")
"""Lengths of a row of a table, and of a placement in the frame of the link before. The z of this frame is the
axis of the link's joint, also where a URDF writes another axis, and fixed joints between are part of it."""
_GENERAL = 0.0731
"""A change of lengths, m per number of the joint, after which none is zero."""


class LinkLength(Conflict):
    """Change one length of one row, with all parameters fitted again."""

    name = "link_length"
    title = "Length of a link"

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Give the likeliest error of every length that the logs show."""
        for place, link in enumerate(setup.robot.links):
            for entry in _shown_entries(link):
                change = _likeliest(setup, trials, place, entry)
                if abs(change) < LENGTH.least:
                    continue
                yield Hypothesis(
                    self.name,
                    (link.joint,),
                    None,
                    _changed(setup, trials, place, entry, change),
                    *_words(link, entry, change),
                )


def _words(link: Link, entry: str, change: float) -> tuple[str, str]:
    """Give statement and remedy."""
    before, joint = _length(link, entry), link.joint
    after = before + change
    if link.row is not None:
        statement = f"the length {entry} of joint {joint} is {after:.3g} m, not {before:.3g} m"
        return statement, f"describe joint {joint} with {entry} = {after:.4g} m"
    where = f"along {entry} of the frame of link {link.antecedent}, whose z is the axis of its joint"
    statement = f"joint {joint} lies {after:.3g} m, not {before:.3g} m, {where}"
    return statement, f"describe joint {joint} with a translation of {after:.4g} m {where}"


def _shown_entries(link: Link) -> tuple[str, ...]:
    """Give the lengths that may show: none of the first link, and none along the joint's own stroke."""
    if link.antecedent == 0:
        return ()
    if link.row is not None:
        return ROW if link.kind == "revolute" else ROW[:1]
    stroke = int(np.argmax(np.abs(link.rotation[:, 2]))) if link.kind == "prismatic" else None
    return tuple(entry for axis, entry in enumerate(PLACE) if axis != stroke)


def _likeliest(setup: Setup, trials: Trials, place: int, entry: str) -> float:
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
        return tuple(
            _lengthened(link, dict.fromkeys(_shown_entries(link), _GENERAL * link.joint))
            for link in setup.robot.links
        )

    return trials.links(setup, ("general",), general)


def _changed(setup: Setup, trials: Trials, place: int, entry: str, change: float) -> Setup:
    if change == 0.0:
        return setup

    def changed() -> tuple[Link, ...]:
        links = setup.robot.links
        return (*links[:place], _lengthened(links[place], {entry: change}), *links[place + 1 :])

    return setup.with_links(trials.links(setup, (place, entry, change), changed))


def _lengthened(link: Link, changes: Mapping[str, float]) -> Link:
    """Add errors, m, to lengths."""
    if link.row is None:
        return replace(link, translation=link.translation + [changes.get(entry, 0.0) for entry in PLACE])
    row = replace(link.row, **{entry: _length(link, entry) + change for entry, change in changes.items()})
    rotation, translation = row.placement()
    return replace(link, rotation=rotation, translation=translation, row=row)


def _length(link: Link, entry: str) -> float:
    return float(link.translation[PLACE.index(entry)] if link.row is None else getattr(link.row, entry))
