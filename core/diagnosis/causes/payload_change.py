"""Candidate cause: a body attached to a link or removed from it, at an instant or since the reference."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.term import Term
from ...dynamics.terms.payload_change import Payload
from ...robot.model import INERTIAL_SYMBOLS, RobotModel
from ..dataset.dataset import Dataset
from ..thresholds.causes import ADMISSIBLE, EVENTS
from .protocol import FittedCause, Numbers, Quantity, Scalars, SearchTraits, Setting, Site, number_text
from .shared.bodies import MASS, body_of, is_body
from .shared.own_joint import NOTHING, OwnJointCause, end_links, links_by_joint

INSTANTS = 16
_FIRST = INERTIAL_SYMBOLS.index("MX")


def _instants_tried(grid: Sequence[Scalars], scalars: Scalars) -> float:
    """Count the instants that are separable."""
    return float(len(grid) * EVENTS.onsets) if scalars else float(len(grid))


@dataclass(frozen=True)
class PayloadChange(OwnJointCause):
    """Candidate cause: a payload.

    A body that was there throughout shows only against a reference: otherwise it is identified as part of the
    last link.
    """

    throughout: bool = False
    """Whether the body was there from before the log's begin to its end, on any link; if not, it came or went
    at an instant that is scanned, on a link that carries no other."""

    id = "payload_change"
    title = "Payload attached or removed"
    cure = "robot"
    units = (("mass", "kg"), ("com_x", "m"), ("com_y", "m"), ("com_z", "m"), ("time", "s"))
    experiment = "the same motion of all joints before and after the change, at least five seconds each"
    coordinate = "time"
    # The weight of a body shows its instant; its inertia hardly does.
    traits = SearchTraits(onset={"time": slice(_FIRST, None)}, trials=_instants_tried)

    def sites(self, dataset: Dataset) -> Sequence[Site]:
        """List the joints of the links that may carry it; several logs have no instant in common."""
        one_clock = self.throughout or len(dataset.motions) == 1
        return [(joint,) for joint in self._links(dataset)] if one_clock else []

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan the instant, where there is one."""
        if self.throughout:
            return NOTHING
        instants = np.linspace(at.dataset.time.min(), at.dataset.time.max(), INSTANTS, endpoint=False)[1:]
        return [{"time": float(value)} for value in instants]

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        return Payload(at.joint, self._links(at.dataset)[at.joint], at.scalars.get("time", -np.inf))

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a mass that an arm may carry and, where all ten parameters are fitted throughout, a body."""
        light = bool(np.isfinite(solved.values).all() and abs(solved.values[MASS]) < ADMISSIBLE.payload)
        return light and (not self.throughout or is_body(solved.values, solved.covariance))

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report mass (negative: removed), centre of mass in the link's frame if observable, and instant.

        A joint on which weight does not act leaves the mass at zero, and the centre open.
        """
        body = body_of(solved.values, solved.covariance)[0] if self.throughout else solved.values
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
            Quantity("time", None, "s", time, solved.deviations.get("time", 0.0), is_instant=True)
            for time in solved.scalars.values()
        ]
        return (*found, *when)

    def statement(self, solved: FittedCause) -> str:
        """State mass, link, instant and centre of mass."""
        found = self.by_name(solved)
        observed = [(axis, found[f"com_{axis}"]) for axis in "xyz" if f"com_{axis}" in found]
        centre = ", ".join(f"{axis} = {coordinate.value:.2g}" for axis, coordinate in observed)
        word = "attached to" if found["mass"].value > 0.0 else "removed from"
        mass = Quantity("mass", None, "kg", abs(found["mass"].value), found["mass"].standard_deviation)
        return (
            f"Payload {word} the link of joint {solved.site[0]}: {mass.text} since "
            f"{self._since(found)}" + (f", centre of mass at {centre} m in its frame" if observed else "")
        )

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State that the body joins as a term, or is identified with its link."""
        del robot
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
        return "the reference" if self.throughout else f"{found['time'].value:.3g} s"
