"""Tell a body that one of several logs has from a gain error of all torques in that log.

Torques that are all larger by one share are those of heavier bodies, and of more friction. A body has ten
free numbers, and takes most of the difference where no gain is on the list. So both are scored in one place.
"""

from dataclasses import dataclass

import numpy as np

from ...dynamics.term import Term
from ...dynamics.terms.torque_gain import GainOfLog
from ..causes.protocol import FittedCause, Setting
from ..causes.shared.own_joint import OwnJointCause
from ..result import Evidence
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Candidate, Hypothesis


@dataclass(frozen=True)
class _Gain(OwnJointCause):
    id = "gain_of_log"
    title = "Torque gain error in one log"
    units = ()
    coordinate = "torque"

    def term(self, at: Setting) -> Term:
        return GainOfLog(0, at.operating_point, round(at.scalars["log"]) - 1)

    def statement(self, solved: FittedCause) -> str:
        return f"All torques of log {solved.scalars['log']:.0f} have the same gain error"


def gain_evidence(fitter: HypothesisFitter, without: Hypothesis, member: Candidate) -> tuple[Evidence, ...]:
    """Give the lead of a body in one log over a gain error there, by BIC; nothing for other members."""
    if "log" not in member.scalars:
        return ()
    gain = Candidate(_Gain(), (), member.scalars, 1.0)
    body, other = fitter.score(without, [member, gain])
    fitted = fitter.dataset.usable & ~fitter.dataset.held_out[:, None]
    price = float(np.log(max(int(fitted.sum()), 1)))
    lead = body.statistic - other.statistic - price * (body.freedom - other.freedom)
    statement = "Delta BIC to the same gain error of all torques in that log; below 0 the finding is doubtful"
    return (Evidence(statement, "lead over a gain", lead),)


def is_rather_a_gain(evidence: tuple[Evidence, ...]) -> bool:
    """Tell whether the gain error leads."""
    return any(one.value < 0.0 for one in evidence)
