"""Reuse candidates' columns of an earlier operating point where it is near enough, joint by joint.

Most of a scan's cost is the columns, and most changes of the operating point change one joint's torque. The
columns of the other joints' candidates are then unchanged on their own joints, and nearly so on all.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

from ..causes.protocol import Site
from ..regression.rows import Columns
from ..thresholds.search import SEARCH
from .candidates import Candidates
from .hypothesis import Candidate


@dataclass(frozen=True, eq=False)
class CandidateCache:
    """Hold the candidates that act all the time, with columns that may be of an earlier operating point."""

    whole: Candidates
    """The operating point of candidates of several joints or of none."""
    joints: tuple[Candidates, ...]
    """Per joint, the operating point of candidates of that joint alone."""

    @cached_property
    def candidates(self) -> tuple[Candidate, ...]:
        """Give the candidates."""
        return tuple(candidate for candidate, _ in self._placed)

    def of(self, now: Candidates) -> bool:
        """Tell whether all columns are of one operating point."""
        return self._points == (now,)

    def under(self, now: Candidates) -> "CandidateCache":
        """Take the candidates whose columns another operating point changes from there.

        Approximate: columns of derivatives may change by a larger share than the torque does, and so may
        what a candidate of one joint adds on the others.
        """
        changed = {point: ~(point.change(now) <= SEARCH.cached_change) for point in self._points}
        whole = now if changed[self.whole].any() else self.whole
        joints = tuple(now if changed[point][joint] else point for joint, point in enumerate(self.joints))
        return self if (whole, joints) == (self.whole, self.joints) else CandidateCache(whole, joints)

    def columns(self, built: Callable[[Sequence[Candidate], Candidates], Sequence[Columns]]) -> list[Columns]:
        """Give the candidates' columns, each at its operating point."""
        out: dict[int, Columns] = {}
        for point in self._points:
            indices = [index for index, (_, own) in enumerate(self._placed) if own is point]
            columns = built([self.candidates[index] for index in indices], point)
            out |= dict(zip(indices, columns, strict=True))
        return [out[index] for index in range(len(out))]

    @property
    def _points(self) -> tuple[Candidates, ...]:
        return tuple(dict.fromkeys((self.whole, *self.joints)))

    @cached_property
    def _placed(self) -> tuple[tuple[Candidate, Candidates], ...]:
        return tuple(
            (candidate, own)
            for cause, site in self.whole.lasting
            for own in (self._point(site),)
            for candidate in own.of(cause, site)
        )

    def _point(self, site: Site) -> Candidates:
        return self.joints[site[0] - 1] if len(site) == 1 else self.whole


def cache_at(point: Candidates) -> CandidateCache:
    """Take all candidates from one operating point."""
    return CandidateCache(point, (point,) * point.dataset.joints)
