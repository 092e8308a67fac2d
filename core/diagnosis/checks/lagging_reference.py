"""Test whether the logged positions may be the controller's reference, which the joints only follow.

Where the reference turns round, dry friction holds a joint until its controller pulls hard enough. Beside the
reference this looks like friction that builds up over a distance. But then the joint breaks loose and swings
in as its loop does, which no presliding friction does. So that friction is compared with a mass that follows
the logged positions in a loop, with the joint's own dry friction.
Source: Armstrong-Helouvry, Dupont & Canudas de Wit, Automatica 30(7), 1994, for friction in position loops.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..causes.friction_presliding import FrictionPresliding
from ..causes.protocol import Site
from ..result import Finding, UnnamedPattern
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Hypothesis
from ..search.likelihood_ratio import likelihood_ratio, log_p
from ..search.state import SearchState
from ..thresholds.search import SELECTION
from .lack_of_fit import best_unnamed_pattern, loop_candidates
from .reservations import as_doubtful


def lagging_reference(found: SearchState) -> UnnamedPattern | None:
    """Give the loop, if loops explain the torque better than all presliding friction that a search found.

    A recorder that logs the reference does so on all joints: more than half of them have to lag.

    Parameters
    ----------
    found
        The result of the search, before alternatives are compared.
    """
    fitter, chosen = found.fitter, found.chosen
    sites = [member.site for member in chosen.members if member.cause.id == FrictionPresliding.id]
    others = tuple(member for member in chosen.members if member.cause.id != FrictionPresliding.id)
    if not sites:
        return None
    without = fitter.fit(others)
    steps = _loops_on(sites, fitter, without)
    if not 2 * len(steps) > fitter.dataset.joints:
        return None
    # Both have a size and a scalar per joint: no criterion has to weigh one number against another.
    lead = likelihood_ratio(without, steps[-1].after) - likelihood_ratio(without, chosen)
    clearest = max(steps, key=lambda step: likelihood_ratio(step.before, step.after))
    return _pattern(found, clearest) if lead > SELECTION.undecided else None


class _Step(NamedTuple):
    """Hold the fits before and after one more joint lags."""

    before: Hypothesis
    after: Hypothesis


def _loops_on(sites: Sequence[Site], fitter: HypothesisFitter, without: Hypothesis) -> list[_Step]:
    """Let one joint after the other lag, where a loop explains something."""
    now, steps = without, list[_Step]()
    for site in sites:
        trial = best_unnamed_pattern(fitter, now, loop_candidates(fitter, site))
        if trial is not None:
            steps.append(_Step(now, trial))
            now = trial
    return steps


def beside_reference(findings: Sequence[Finding], lagging: UnnamedPattern | None) -> list[Finding]:
    """Limit what a search found where the positions may be a reference; what samples show stays."""
    return [
        finding if lagging is None or finding.member is None else as_doubtful(finding) for finding in findings
    ]


def _pattern(found: SearchState, step: _Step) -> UnnamedPattern:
    now, trial = step
    last, dataset = trial.members[-1], found.fitter.dataset
    solved = trial.in_joint_units(len(trial.members) - 1, dataset.robot)
    return UnnamedPattern(
        joint=last.site[0],
        statement=f"{last.cause.statement(solved)}; check whether the log's positions are the reference",
        statistic=likelihood_ratio(now, trial),
        log10_p=(log_p(now, trial) + float(np.log(dataset.joints))) / float(np.log(10.0)),
    )
