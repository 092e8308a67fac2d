"""Suspect that the torque channel is low-pass filtered and the positions are not."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.diagnosis.cause import Confusion, Scalars, Site, Solved
from core.diagnosis.causes.common import OwnJointCause, named, rounded
from core.diagnosis.look import Look
from core.diagnosis.misfit import settled
from core.dynamics.prediction import Prediction
from core.dynamics.term import Term
from core.dynamics.terms.filter_lag import FilterLag

SHORTEST, LONGEST = 2e-4, 0.1
"""Time constants in s: less does nothing in any log's band, more leaves no motion in the torque."""
START = 0.005


@dataclass(frozen=True)
class TorqueFilterLag(OwnJointCause):
    """Suspect a filter in the torque channel."""

    id = "torque_filter_lag"
    excludes = ("time_delay",)
    title = "The torque channel is low-pass filtered"
    cure = "signal"
    units = (("time_constant", "s"),)
    confusions = (
        Confusion(
            "time_delay",
            "to first order in frequency both are late alike; they differ by its square",
            "excite at several frequencies up to a fifth of the sampling rate: a filter weakens quick ones",
            share=0.4,
        ),
        Confusion(
            "joint_elasticity",
            "a compliant gear also makes the torque seem late, by an amount that depends on joint and load",
            "repeat the motion with and without a payload: a filter stays the same",
        ),
    )
    experiment = "motion with quick reversals, five times the present frequencies"
    coordinate = "torque_rate"

    def sites(self, look: Look, believed: Prediction) -> Sequence[Site]:
        """Act on the whole robot."""
        del look, believed
        return [()]

    def term(self, look: Look, believed: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns at the time constant that they yield themselves."""
        del site, scalars

        def build(time_constant: float) -> Term:
            return FilterLag(0, believed, float(np.clip(time_constant, SHORTEST, LONGEST)))

        return build(settled(look, believed, build, START))

    def possible(self, solved: Solved) -> bool:
        """Want a filter that lags."""
        return bool(0.0 < solved.values[0] < LONGEST)

    def statement(self, solved: Solved) -> str:
        """Say with which time constant."""
        found = named(self.quantities(solved))["time_constant"]
        return (
            f"The torque channel is low-pass filtered on all joints: time constant {1e3 * found.value:.3g} ± "
            f"{rounded(1e3 * found.standard_deviation)} ms, the positions are not"
        )
