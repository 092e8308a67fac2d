"""Suspect that something pushed against the last link for a while."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.diagnosis.cause import Confusion, Quantity, Scalars, Site, Solved
from core.diagnosis.causes.common import OwnJointCause, named
from core.diagnosis.causes.sites import end_links
from core.diagnosis.look import Look
from core.diagnosis.misfit import fitted_rows, misfit, size_of
from core.dynamics.prediction import Prediction
from core.dynamics.term import Term
from core.dynamics.terms.contact import Contact, push_torques

SHORTEST, LONGEST = 0.1, 3.2
"""Lengths in s: shorter ones are outliers, longer ones weights."""
KEPT = 4
"""Windows that are handed on of all that were looked at."""
STRONGEST = 1e4


@dataclass(frozen=True)
class ExternalContact(OwnJointCause):
    """Suspect contact."""

    id = "external_contact"
    title = "Something pushed against the robot"
    confusions = (
        Confusion(
            "payload_change",
            "a push that lasts to the log's end looks like a weight, until the arm accelerates",
            "repeat the motion in free space",
        ),
    )
    experiment = "the same motion again with nothing within reach"
    coordinate = "time"

    def sites(self, look: Look, believed: Prediction) -> Sequence[Site]:
        """List the joints of links that carry no other, where one log tells what the time is."""
        del believed
        return [(joint,) for joint in end_links(look.robot)] if len(look.motions) == 1 else []

    def grid(self, look: Look, believed: Prediction, site: Site) -> Sequence[Scalars]:
        """Look at windows of doubling length, half a length apart, and keep the best that do not overlap."""
        left, mask = misfit(look, believed), look.clear
        weight = mask / size_of(left, fitted_rows(look))
        push = push_torques(look.robot, end_links(look.robot)[site[0]], look.state) * weight
        gain = np.einsum("arj,rj->ra", push, left * weight)
        gram = np.einsum("arj,brj->rab", push, push)
        windows = _windows(look)
        inside = [(look.time >= begin) & (look.time < begin + length) for begin, length in windows]
        worth = [_worth(gram[rows].sum(axis=0), gain[rows].sum(axis=0)) for rows in inside]
        kept: list[tuple[float, float]] = []
        for index in np.argsort(worth)[::-1]:
            begin, length = windows[index]
            if all(begin >= one + width or begin + length <= one for one, width in kept):
                kept.append((begin, length))
            if len(kept) == KEPT:
                break
        return [{"begin": begin, "length": length} for begin, length in kept]

    def trials(self, look: Look) -> int:
        """Count the windows that were looked at."""
        return len(_windows(look))

    def term(self, look: Look, believed: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns."""
        del believed
        return Contact(site[0], end_links(look.robot)[site[0]], scalars["begin"], scalars["length"])

    def possible(self, solved: Solved) -> bool:
        """Want a force that leaves the robot whole, for a time that can be told from an outlier."""
        force = float(np.linalg.norm(solved.values))
        return bool(force < STRONGEST and solved.scalars["length"] >= 0.5 * SHORTEST)

    def quantities(self, solved: Solved) -> tuple[Quantity, ...]:
        """Report the interval, the force on the robot in the base frame, and its size."""
        joint, size = solved.site[0], float(np.linalg.norm(solved.values))
        deviations = np.sqrt(np.maximum(np.diag(solved.covariance), 0.0))
        along = solved.values / max(size, 1e-300)
        begin, length = solved.scalars["begin"], solved.scalars["length"]
        early, long = (solved.deviations.get(name, 0.0) for name in ("begin", "length"))
        return (
            Quantity("begin", None, "s", begin, early),
            Quantity("end", None, "s", begin + length, float(np.hypot(early, long))),
            Quantity("force", joint, "N", size, float(np.sqrt(max(along @ solved.covariance @ along, 0.0)))),
            *(
                Quantity(f"force_{axis}", joint, "N", float(value), float(deviation))
                for axis, value, deviation in zip("xyz", solved.values, deviations, strict=True)
            ),
        )

    def statement(self, solved: Solved) -> str:
        """Say when and how hard."""
        found = named(self.quantities(solved))
        return (
            f"From {found['begin'].value:.3g} s to {found['end'].value:.3g} s something pushed with "
            f"{found['force'].value:.3g} ± {found['force'].standard_deviation:.1g} N against "
            f"joint {solved.site[0]}'s link"
        )


def _windows(look: Look) -> list[tuple[float, float]]:
    first, last = float(look.time.min()), float(look.time.max())
    lengths = SHORTEST * 2.0 ** np.arange(int(np.log2(LONGEST / SHORTEST)) + 1)
    return [
        (float(begin), float(length))
        for length in lengths
        for begin in np.arange(first, last - 0.5 * length, 0.5 * length)
    ]


def _worth(gram: np.ndarray, gain: np.ndarray) -> float:
    """Give how much of the weighted square a force explains; directions without leverage explain nothing."""
    scale = float(np.trace(gram))
    if scale <= 0.0:
        return 0.0
    return float(gain @ np.linalg.solve(gram + 1e-9 * scale * np.eye(3), gain))
