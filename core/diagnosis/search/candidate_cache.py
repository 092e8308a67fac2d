"""Rank what is suspected all along the motion, site by site under the earliest belief that will do.

A scan over everything costs most where columns have to be built, and most beliefs change one joint's torque.
What is suspected of the others is then as it was on their own joints, and nearly so on all.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

from ..causes.protocol import Site
from ..regression.rows import Columns
from .candidates import Candidates
from .hypothesis import Candidate

NEAR = 0.01
"""Share of a joint's torque within which two predictions rank candidates of the joint alike."""


@dataclass(frozen=True, eq=False)
class CandidateCache:
    """Keep what is suspected all along the motion, to be ranked by columns that may be of an earlier belief.

    Attributes
    ----------
    whole
        The suspicion that candidates of several joints or of none are of.
    joints
        Per joint, the suspicion that candidates of that joint alone are of.
    """

    whole: Candidates
    joints: tuple[Candidates, ...]

    @cached_property
    def candidates(self) -> tuple[Candidate, ...]:
        """Give what is suspected."""
        return tuple(candidate for candidate, _ in self._suspected)

    def of(self, now: Candidates) -> bool:
        """Tell whether everything is of one suspicion."""
        return self._suspicions == (now,)

    def under(self, now: Candidates) -> "CandidateCache":
        """Take what another belief would rank otherwise from the suspicion under that belief.

        Roughly: columns made of derivatives may change by a greater share than what is predicted does, and so
        may what a candidate of one joint adds on the others.
        """
        changed = {one: ~(one.change(now) <= NEAR) for one in self._suspicions}
        whole = now if changed[self.whole].any() else self.whole
        joints = tuple(now if changed[one][joint] else one for joint, one in enumerate(self.joints))
        return self if (whole, joints) == (self.whole, self.joints) else CandidateCache(whole, joints)

    def columns(self, built: Callable[[Sequence[Candidate], Candidates], Sequence[Columns]]) -> list[Columns]:
        """Give the candidates' columns, each as a bench builds it under its suspicion."""
        out: dict[int, Columns] = {}
        for suspicion in self._suspicions:
            places = [place for place, (_, own) in enumerate(self._suspected) if own is suspicion]
            columns = built([self.candidates[place] for place in places], suspicion)
            out |= dict(zip(places, columns, strict=True))
        return [out[place] for place in range(len(out))]

    @property
    def _suspicions(self) -> tuple[Candidates, ...]:
        return tuple(dict.fromkeys((self.whole, *self.joints)))

    @cached_property
    def _suspected(self) -> tuple[tuple[Candidate, Candidates], ...]:
        return tuple(
            (candidate, own)
            for cause, site in self.whole.lasting
            for own in (self._suspicion(site),)
            for candidate in own.of(cause, site)
        )

    def _suspicion(self, site: Site) -> Candidates:
        return self.joints[site[0] - 1] if len(site) == 1 else self.whole


def cache_at(suspicion: Candidates) -> CandidateCache:
    """Rank everything under one belief."""
    return CandidateCache(suspicion, (suspicion,) * suspicion.dataset.joints)
