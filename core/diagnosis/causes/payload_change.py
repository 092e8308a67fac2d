"""Suspect that a body was fixed to the last link or taken off it, at some instant or before the log began."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.diagnosis.cause import Confusion, Quantity, Scalars, Site, Solved
from core.diagnosis.causes.common import OwnJointCause, named, shown
from core.diagnosis.causes.sites import end_links
from core.diagnosis.look import Look
from core.dynamics.prediction import Prediction
from core.dynamics.term import Term
from core.dynamics.terms.payload import Payload
from core.robot.parameters import INERTIAL_SYMBOLS

INSTANTS = 12
HEAVIEST = 500.0
_MASS = INERTIAL_SYMBOLS.index("M")
_FIRST = INERTIAL_SYMBOLS.index("MX")


@dataclass(frozen=True)
class PayloadChange(OwnJointCause):
    """Suspect a payload.

    A body that was there throughout is one of the instants scanned: against a reference it shows, and where
    everything was identified anew it is part of the last link and cannot.
    """

    id = "payload_change"
    title = "A body was attached to or taken off the last link"
    cure = "robot"
    units = (("mass", "kg"), ("com_x", "m"), ("com_y", "m"), ("com_z", "m"), ("time", "s"))
    confusions = (
        Confusion(
            "torque_offset_drift",
            "a step of weight in one posture is a step of the offset",
            "keep moving all joints after the change",
        ),
        Confusion(
            "external_contact",
            "a push that lasts to the log's end looks like a weight, until the arm accelerates",
            "move quickly after the change: only a body has inertia",
        ),
    )
    experiment = "the same motion of all joints before and after the change, at least five seconds each"
    coordinate = "time"

    def sites(self, look: Look, believed: Prediction) -> Sequence[Site]:
        """List the joints of links that carry no other."""
        del believed
        return [(joint,) for joint in end_links(look.robot)]

    def grid(self, look: Look, believed: Prediction, site: Site) -> Sequence[Scalars]:
        """Scan the instant, the log's first one included; several logs have no instant in common."""
        del believed, site
        first, last = float(look.time.min()), float(look.time.max())
        count = INSTANTS if len(look.motions) == 1 else 1
        return [{"time": float(value)} for value in np.linspace(first, last, count, endpoint=False)]

    def term(self, look: Look, believed: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns."""
        del believed
        return Payload(site[0], end_links(look.robot)[site[0]], scalars["time"])

    def possible(self, solved: Solved) -> bool:
        """Want a mass that an arm may carry; whether the body can exist is for the estimate to see to."""
        return bool(np.isfinite(solved.values).all() and abs(solved.values[_MASS]) < HEAVIEST)

    def quantities(self, solved: Solved) -> tuple[Quantity, ...]:
        """Report mass (negative: taken off), mass centre in the link's frame, and instant."""
        joint, mass = solved.site[0], float(solved.values[_MASS])
        deviations = np.sqrt(np.maximum(np.diag(solved.covariance), 0.0))
        found = [Quantity("mass", joint, "kg", mass, float(deviations[_MASS]))]
        for place, axis in enumerate("xyz", start=_FIRST):
            centre = float(solved.values[place]) / mass
            slope = np.zeros(len(solved.values))
            slope[place], slope[_MASS] = 1.0 / mass, -centre / mass
            deviation = float(np.sqrt(max(slope @ solved.covariance @ slope, 0.0)))
            found.append(Quantity(f"com_{axis}", joint, "m", centre, deviation))
        time = solved.scalars["time"]
        return (*found, Quantity("time", None, "s", time, solved.deviations.get("time", 0.0)))

    def statement(self, solved: Solved) -> str:
        """Say what mass, where and since when."""
        found = named(self.quantities(solved))
        centre = ", ".join(f"{found[f'com_{axis}'].value:.2g}" for axis in "xyz")
        word = "carries" if found["mass"].value > 0.0 else "has lost"
        mass = Quantity("mass", None, "kg", abs(found["mass"].value), found["mass"].standard_deviation)
        return (
            f"The link of joint {solved.site[0]} {word} {shown(mass)} since {found['time'].value:.3g} s, "
            f"centred at ({centre}) m in its frame"
        )
