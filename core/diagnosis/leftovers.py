"""Tell a cause from what another one leaves: by what it keeps beside that one, and by where it acts."""

from core.diagnosis.bench import Bench
from core.diagnosis.hypothesis import Candidate, Hypothesis
from core.diagnosis.rise import rise

BESIDE_SHARE = 0.5
"""What keeps this share of its rise beside a finding is no rival to it."""
WITHIN = 0.9
"""Share of an event's rows in which another cause acts, from which on it is what that one leaves."""


def left_over(bench: Bench, whole: Hypothesis, index: int, own_rise: float) -> bool:
    """Tell whether a member looks like what another one leaves, and brings too little for a cause.

    An event does where it happens only while the other acts.
    """
    own = whole.members[index].cause
    for place, other in enumerate(whole.members):
        if place != index and own.id in other.cause.leaves:
            if own.event:
                if _acts_within(whole, index, place):
                    return True
                continue
            without = bench.tried((*whole.members[:place], *whole.members[place + 1 :]), whole)
            if own_rise < BESIDE_SHARE * rise(without, whole):
                return True
    return False


def keeps_beside(bench: Bench, own: Hypothesis, rival: Candidate, alone: float) -> bool:
    """Tell whether a candidate keeps its rise beside a hypothesis: then it is no rival."""
    return bench.scanned(own, [rival])[0].statistic > BESIDE_SHARE * alone


def left_by_last(bench: Bench, own: Hypothesis, rival: Candidate) -> bool:
    """Tell whether a candidate is an event that the last member leaves, as by its own torque at its limit."""
    if not rival.cause.event or rival.cause.id not in own.members[-1].cause.leaves:
        return False
    both = bench.added(own, rival)
    return _acts_within(both, len(own.members), len(own.members) - 1)


def _acts_within(whole: Hypothesis, index: int, place: int) -> bool:
    """Tell whether one member acts hardly ever but while another does, on the joints of the other."""
    together = alone = 0
    for part in whole.fit.joints:
        acts, other = (part.columns[:, whole.columns_of(one)].any(axis=1) for one in (index, place))
        if other.any():
            together += int((acts & other).sum())
            alone += int((acts & ~other).sum())
    return together > WITHIN * (together + alone)
