"""Find the quantisation step of a signal, and whether it is coarse against the signal itself.

On a grid every increment is a whole number of steps; the smallest increment is then the step. Velocity
inherits the step divided by the sample time, which is why a fast log of a coarse encoder needs filtering.
"""

from collections.abc import Iterator

import numpy as np

from ...arrays import JointVector, Samples, Series
from ..model import Defect
from .stretch import Facts, Stretch, sampled_share

SAMPLED_ROWS = 20_000
SMALL_STEPS = 20
"""Increments of up to this many steps show the grid; larger ones lose it in rounding."""
FEWEST_INCREMENTS = 50
NEAR = 0.1
"""Steps by which an increment that counts as a whole number of them may differ from it."""
ON_GRID = 0.98
COARSE_POSITION_STEPS = 3.0
COARSE_TORQUE_SHARE = 0.05


class Resolution:
    """Keep a bounded sample of the increments of position and torque."""

    def __init__(self, samples: int) -> None:
        self._share = sampled_share(samples, SAMPLED_ROWS)
        self._increments: dict[str, list[Series]] = {"position": [], "torque": []}

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        rows = max(int(self._share * stretch.position.shape[1]), 2)
        for channel, values in (("position", stretch.position), ("torque", stretch.torque)):
            if values is not None:
                self._increments[channel].append(np.abs(np.diff(values[:, :rows], axis=1)))

    def lsb(self, channel: str) -> JointVector:
        """Give each joint's grid step, 0 where the signal lies on none that shows."""
        return np.array([_grid_step(row)[0] for row in np.hstack(self._increments[channel])])

    def defects(self, facts: Facts) -> list[Defect]:
        """State where the grid is coarse."""
        found: list[Defect] = []
        for channel, kept in self._increments.items():
            for joint, row in enumerate(np.hstack(kept) if kept else ()):
                found += _coarse_grid(channel, joint, row, facts)
        return found


def _coarse_grid(channel: str, joint: int, increments: Samples, facts: Facts) -> Iterator[Defect]:
    """Give the defect of one joint's signal; nothing where its grid is fine or does not show."""
    step, typical = _grid_step(increments)
    if step == 0.0:
        return
    if channel == "position":
        coarse, share = typical <= COARSE_POSITION_STEPS * step and facts.travels(joint), typical / step
    else:
        deviation = float(facts.deviation[channel][joint])
        coarse, share = step > COARSE_TORQUE_SHARE * deviation, step / deviation
    if coarse:
        statement = _statement(channel, joint, step, share, facts)
        yield Defect("quantisation", channel, joint + 1, facts.samples, (), statement)


def _grid_step(increments: Samples) -> tuple[float, float]:
    """Give the grid step (0 if there is none) and the median of the increments that are not zero."""
    moved = increments[increments > 0.0]
    if len(moved) < FEWEST_INCREMENTS:
        return 0.0, 0.0
    smallest = float(moved.min())
    ratios = moved[moved < SMALL_STEPS * smallest] / smallest
    on_grid = np.abs(ratios - np.round(ratios)) < NEAR
    if len(ratios) < FEWEST_INCREMENTS or np.mean(on_grid) < ON_GRID:
        return 0.0, float(np.median(moved))
    return smallest, float(np.median(moved))


def _statement(channel: str, joint: int, step: float, share: float, facts: Facts) -> str:
    unit = facts.units[channel][joint]
    size = f"Joint {joint + 1}'s {channel} comes in steps of {step:.3g} {unit} (lsb)"
    if channel == "torque":
        return f"{size}, {100.0 * share:.2g} % of its standard deviation."
    return (
        f"{size} and typically moves {share:.2g} of them per sample; one step is "
        f"{step / (2.0 * facts.step):.3g} {unit}/s of centred velocity."
    )
