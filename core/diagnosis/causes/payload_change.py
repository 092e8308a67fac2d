"""Candidate cause: a body attached to a link or removed, at an instant, in a log, or since the reference."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.term import Term
from ...dynamics.terms.payload_change import Payload, PayloadOfLog
from ...robot.model import INERTIAL_SYMBOLS, RobotModel
from ..dataset.dataset import Dataset
from ..thresholds.causes import ADMISSIBLE, EVENTS
from .protocol import FittedCause, Numbers, Quantity, Scalars, SearchTraits, Setting, Site, number_text
from .shared.bodies import MASS, body_of, is_body
from .shared.own_joint import NOTHING, OwnJointCause, end_links, links_by_joint

INSTANTS = 16
_FIRST = INERTIAL_SYMBOLS.index("MX")


def _instants_tried(grid: Sequence[Scalars], scalars: Scalars) -> float:
    """Count the instants that are separable; of logs all are on the grid."""
    return float(len(grid) * EVENTS.onsets) if "time" in scalars else float(len(grid))


@dataclass(frozen=True)
class PayloadChange(OwnJointCause):
    """Candidate cause: a payload.

    A body that was there throughout shows only against a reference: otherwise it is identified as part of the
    last link.
    """

    throughout: bool = False
    """Whether the body was there from before the log's begin to its end, on any link; if not, it came or went
    at an instant that is scanned, or is there in one of several logs, on a link that carries no other."""

    id = "payload_change"
    title = "Payload attached or removed"
    cure = "robot"
    units = (("mass", "kg"), ("com_x", "m"), ("com_y", "m"), ("com_z", "m"), ("time", "s"), ("log", "1"))
    experiment = "the same motion of all joints before and after the change, at least five seconds each"
    coordinate = "time"
    # The weight of a body shows its instant; its inertia hardly does.
    traits = SearchTraits(onset={"time": slice(_FIRST, None)}, discrete=("log",), trials=_instants_tried)

    def sites(self, dataset: Dataset) -> Sequence[Site]:
        """List the joints of the links that may carry it."""
        return [(joint,) for joint in self._links(dataset)]

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan the instant, or the logs: several have no instant in common.

        Of two logs, one with a body is one without beside it.
        """
        if self.throughout:
            return NOTHING
        logs = range(1, len(at.dataset.motions) + 1)
        if len(logs) > 1:
            return [{"log": float(number)} for number in (logs[1:] if len(logs) == 2 else logs)]
        instants = np.linspace(at.dataset.time.min(), at.dataset.time.max(), INSTANTS, endpoint=False)[1:]
        return [{"time": float(value)} for value in instants]

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        link = self._links(at.dataset)[at.joint]
        if "log" in at.scalars:
            return PayloadOfLog(at.joint, link, round(at.scalars["log"]) - 1)
        return Payload(at.joint, link, at.scalars.get("time", -np.inf))

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a mass that an arm may carry and, where a whole log shows all ten parameters, a body."""
        whole = self.throughout or "log" in solved.scalars
        light = bool(np.isfinite(solved.values).all() and abs(solved.values[MASS]) < ADMISSIBLE.payload)
        return light and (not whole or is_body(solved.values, solved.covariance))

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report mass (negative: removed), centre of mass in the link's frame if observable, and instant.

        A joint on which weight does not act leaves the mass at zero, and the centre open.
        """
        whole = self.throughout or "log" in solved.scalars
        body = body_of(solved.values, solved.covariance)[0] if whole else solved.values
        joint, mass = solved.site[0], float(body[MASS])
        deviations = np.sqrt(np.maximum(np.diag(solved.covariance), 0.0))
        found = [Quantity("mass", joint, "kg", mass, float(deviations[MASS]))]
        for index, axis in enumerate("xyz" if mass else "", start=_FIRST):
            centre = float(body[index]) / mass
            slope = np.zeros(len(body))
            slope[index], slope[MASS] = 1.0 / mass, -centre / mass
            deviation = float(np.sqrt(max(slope @ solved.covariance @ slope, 0.0)))
            if deviation < ADMISSIBLE.payload_centre:
                found.append(Quantity(f"com_{axis}", joint, "m", centre, deviation))
        when = [
            Quantity(
                name, None, unit, solved.scalars[name], solved.deviations.get(name, 0.0), is_instant=True
            )
            for name, unit in (("time", "s"), ("log", "1"))
            if name in solved.scalars
        ]
        return (*found, *when)

    def statement(self, solved: FittedCause) -> str:
        """State mass, link, instant and centre of mass."""
        found = self.by_name(solved)
        observed = [(axis, found[f"com_{axis}"]) for axis in "xyz" if f"com_{axis}" in found]
        centre = ", ".join(f"{axis} = {coordinate.value:.2g}" for axis, coordinate in observed)
        word = "attached to" if found["mass"].value > 0.0 else "removed from"
        mass = Quantity("mass", None, "kg", abs(found["mass"].value), found["mass"].standard_deviation)
        return f"Payload {word} the link of joint {solved.site[0]}: {mass.text} {self._since(found)}" + (
            f", centre of mass at {centre} m in its frame" if observed else ""
        )

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State that the body joins as a term, or is identified with its link."""
        del robot
        if "log" in numbers:
            return (
                "The description stays as it is: the model has the body as a term in log "
                f"{number_text(numbers['log'])}"
            )
        if "time" in numbers:
            return (
                "The description stays as it is: the model has the body as a term from "
                f"{number_text(numbers['time'], 4)} s on"
            )
        return (
            "The description stays as it is: a new identification includes the body in the link of joint "
            f"{joints[0]}"
        )

    def _links(self, dataset: Dataset) -> dict[int, int]:
        return links_by_joint(dataset.robot) if self.throughout else end_links(dataset.robot)

    def _since(self, found: Mapping[str, Quantity]) -> str:
        if "log" in found:
            return f"in log {found['log'].value:.0f}"
        return "since the reference" if self.throughout else f"since {found['time'].value:.3g} s"
