"""Pass over a log once: refuse what cannot be used, and collect everything else that is wrong with it.

The contract is checked first; the finders get only samples that it accepts, so that all values are finite.
Spikes come next; the other finders get medians in their place, so that one absurd sample is one defect.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...arrays import JointMarks, JointVector
from ..channels import EFFORTS
from ..columns.layout import Layout
from ..contract import Contract, check_length, check_sequence
from ..model import Defect, LogSource
from .bandwidth import Bandwidth
from .clock import Clock, longest_bridge
from .direction import Direction
from .filled import Filled
from .leaps import Leaps
from .plausibility import plausibility_defects
from .reference import Reference
from .repeats import Repeats, cut
from .replays import Replays
from .resolution import Resolution
from .rest import Rest
from .saturation import Saturation
from .shared import Shared
from .spikes import Spikes
from .stretch import Facts, Finder, Stretch, stretches
from .stuck import Stuck
from .unpowered import Unpowered
from .unsigned import Unsigned
from .velocity import Velocity


@dataclass(frozen=True)
class Examination:
    """Carry what one pass over a log found; see `JointLog` for the fields."""

    rate_hz: float
    duration: float
    segments: tuple[tuple[int, int], ...]
    defects: tuple[Defect, ...]


def examine(source: LogSource, layout: Layout, row_in_file: Callable[[int], int] = int) -> Examination:
    """Read all samples once.

    Parameters
    ----------
    source
        The samples.
    layout
        Names the columns in errors.
    row_in_file
        Gives the number that a row of the source has in the file.

    Raises
    ------
    LogError
        If the samples cannot be used.
    """
    samples, joints = source.samples, layout.joints
    check_length(samples)
    contract, clock, spread, resolution = (
        Contract(layout, row_in_file),
        Clock(samples),
        _Spread(),
        Resolution(samples),
    )
    repeats, bandwidth, spikes = Repeats(joints), Bandwidth(joints), Spikes(joints)
    stuck, filled, unpowered = Stuck(joints, repeats), Filled(joints, clock), Unpowered(joints)
    leaps = Leaps(layout.si_units()["position"], row_in_file)
    replays = Replays()
    finders: list[Finder] = [
        clock, repeats, stuck, filled, unpowered, Saturation(joints), resolution, Rest(samples),
        bandwidth, Direction(joints), Velocity(joints), Reference(joints), Shared(joints),
        Unsigned(joints),
    ]  # fmt: skip  # a table
    accepted = True
    for stretch in stretches(source):
        accepted = contract.accepts(stretch) and accepted
        if accepted:
            replays.update(stretch)
            usual = spikes.taken_from(stretch)
            leaps.update(usual)
            spread.update(usual)
            for finder in finders:
                finder.update(usual)
    contract.check()
    leaps.check(replays.rows())
    facts = Facts(
        samples=samples,
        start=contract.start,
        duration=contract.stop - contract.start,
        step=clock.step,
        low=spread.low,
        high=spread.high,
        deviation=spread.deviation(),
        roughness=spread.roughness(),
        whole=spread.whole,
        position_lsb=resolution.lsb("position"),
        units=layout.si_units(),
    )
    check_sequence(facts)
    clock.bridge = longest_bridge(clock.mean_step, bandwidth.highest(facts))
    found = [
        *spikes.defects(facts),
        *replays.defects(facts),
        *(defect for finder in finders for defect in finder.defects(facts)),
    ]
    apart = (
        *repeats.frozen, *replays.rows(), *stuck.rows(facts), *filled.rows(), *unpowered.rows(facts),
    )  # fmt: skip  # a table
    return Examination(
        rate_hz=1.0 / facts.step,
        duration=facts.duration,
        segments=cut(clock.segments(), apart),
        defects=(*found, *plausibility_defects(facts)),
    )


class _Spread:
    """Sum up the deviation of position and torque, about the first sample to keep digits, and the steps.

    The extremes of every channel are followed beside.
    """

    def __init__(self) -> None:
        self._origin: dict[str, JointVector] = {}
        self._sums: dict[str, JointVector] = {}
        self._squares: dict[str, JointVector] = {}
        self._increments: JointVector | float = 0.0
        self._rows = 0
        self.whole: dict[str, JointMarks] = {}
        """Joints whose torque or current comes in whole numbers only."""
        self.low: dict[str, JointVector] = {}
        self.high: dict[str, JointVector] = {}

    def update(self, stretch: Stretch) -> None:
        channels = stretch.new()
        for name, values in channels.items():
            self.low[name] = np.fmin(self.low.get(name, np.inf), values.min(axis=1))
            self.high[name] = np.fmax(self.high.get(name, -np.inf), values.max(axis=1))
        self._rows += channels["position"].shape[1]
        steps = np.diff(stretch.position[:, stretch.first_new :], axis=1)
        self._increments = self._increments + np.einsum("ij,ij->i", steps, steps)
        for name in EFFORTS:
            if name in channels:
                own = np.all(channels[name] == np.rint(channels[name]), axis=1)
                self.whole[name] = self.whole.get(name, own) & own
        for name in ("position", "torque"):
            if name in channels:
                origin = self._origin.setdefault(name, channels[name][:, 0].copy())
                centred = channels[name] - origin[:, None]
                self._sums[name] = self._sums.get(name, np.zeros(len(origin))) + centred.sum(axis=1)
                self._squares[name] = self._squares.get(name, 0.0) + np.einsum("ij,ij->i", centred, centred)

    def deviation(self) -> dict[str, JointVector]:
        means = {name: total / self._rows for name, total in self._sums.items()}
        return {
            name: np.sqrt(np.maximum(squares / self._rows - means[name] ** 2, 0.0))
            for name, squares in self._squares.items()
        }

    def roughness(self) -> JointVector:
        """Give von Neumann's ratio of the positions: 0 for a slow motion, 2 for samples without order."""
        power = self._rows * self.deviation()["position"] ** 2
        return np.asarray(self._increments / np.maximum(power, np.finfo(float).tiny))
