"""Refuse samples that no study can use: out of order, too few, or without any motion or torque.

All of it is counted in one pass over the log, so that an error states how much is wrong and where it starts.
"""

from collections.abc import Callable

import numpy as np

from ..arrays import JointVector, Series
from ..errors import LogError
from .channels import EFFORTS
from .columns.layout import Layout
from .defects.stretch import Facts, Stretch

FEWEST_ROWS = 100
SHORTEST_SECONDS = 1.0
SHORTEST_STEP = 1e-6
"""Of time, in s: no drive is sampled at a megahertz."""
UNRELATED, UNRELATED_SPREAD = 2.0, 6.0
"""Von Neumann's ratio of samples without order, and three standard deviations of it times the root of their
number. That of a motion is far below 1, unless it is sampled three times per period or less."""


def check_length(rows: int) -> None:
    """Refuse a log of too few rows.

    Raises
    ------
    LogError
        If there are fewer than `FEWEST_ROWS`.
    """
    if rows < FEWEST_ROWS:
        cause = {0: "the log holds no rows", 1: "the log holds one row only"}.get(
            rows, "the log is too short to study"
        )
        raise LogError(
            cause,
            evidence={"rows": rows, "at_least": FEWEST_ROWS},
            remedy=f"log at least {FEWEST_ROWS} rows and 1 s of motion, better 10 s or more",
        )


def check_sequence(facts: Facts) -> None:
    """Refuse positions that have nothing to do with those of the row before.

    Raises
    ------
    LogError
        If the joints that move do so in rows without order.
    """
    moving = [joint for joint in range(len(facts.roughness)) if facts.travels(joint)]
    least = UNRELATED - UNRELATED_SPREAD / facts.samples**0.5
    if not moving or float(np.mean(facts.roughness[moving])) < least:
        return
    raise LogError(
        "the positions of successive rows do not continue each other: the rows were shuffled "
        "without their stamps",
        evidence={
            "steps_over_variance": [round(float(facts.roughness[joint]), 3) for joint in moving],
            "without_order": UNRELATED,
            "accepted_below": round(least, 3),
        },
        remedy="take the rows as they were recorded, each with its own stamp; their order does not matter",
    )


class Contract:
    """Follow the extremes of every channel and the order of the stamps.

    Attributes
    ----------
    low, high
        Smallest and largest value by channel and joint.
    """

    def __init__(self, layout: Layout, row_in_file: Callable[[int], int]) -> None:
        self._row_in_file = row_in_file
        self._columns = {channel.name: channel.columns for channel in layout.channels}
        self._backwards = self._duplicates = 0
        self._hurried: float | None = None
        self._first_disorder: tuple[int, float, float] | None = None
        self.low: dict[str, JointVector] = {}
        self.high: dict[str, JointVector] = {}
        self.start = self.stop = np.nan

    def accepts(self, stretch: Stretch) -> bool:
        """Take the next stretch into account; False once anything was found that must be refused."""
        self._order(stretch)
        for name, values in stretch.new().items():
            self._extremes(name, values)
        return not (self._backwards or self._duplicates or self._hurried)

    def _extremes(self, name: str, values: Series) -> None:
        low, high = values.min(axis=1), values.max(axis=1)
        self.low[name] = np.fmin(self.low.get(name, low), low)
        self.high[name] = np.fmax(self.high.get(name, high), high)

    def _order(self, stretch: Stretch) -> None:
        time = stretch.time[stretch.first_new :]
        self.start = float(time[0]) if np.isnan(self.start) else self.start
        self.stop = float(time[-1])
        disorder = np.flatnonzero(time[1:] <= time[:-1])
        typical = float(np.median(np.diff(time))) if len(time) > 1 else SHORTEST_STEP
        if 0.0 < typical < SHORTEST_STEP:
            self._hurried = typical
        if len(disorder):
            self._duplicates += int(np.count_nonzero(time[1:] == time[:-1]))
            self._backwards += int(np.count_nonzero(time[1:] < time[:-1]))
            at = int(disorder[0])
            row = self._row_in_file(stretch.first + stretch.first_new + at + 1) + 1
            self._first_disorder = self._first_disorder or (row, float(time[at]), float(time[at + 1]))

    def check(self) -> None:
        """Refuse the log if it must be.

        Raises
        ------
        LogError
            With what was counted; rows count from 1, the header is none.
        """
        self._check_order()
        if self._hurried is not None:
            raise LogError(
                "the stamps are closer than those of any log",
                evidence={"median_step_s": self._hurried, "at_least_s": SHORTEST_STEP},
                remedy="check the column and the unit of time",
            )
        if self.stop - self.start < SHORTEST_SECONDS:
            raise LogError(
                "the log is too short to study",
                evidence={"duration_s": self.stop - self.start, "at_least_s": SHORTEST_SECONDS},
                remedy="log at least 1 s of motion, better 10 s or more, and check the unit of time",
            )
        self._check_alive()

    def _check_order(self) -> None:
        if self._first_disorder is None:
            return
        row, before, after = self._first_disorder
        cause = "time goes backwards" if self._backwards else "stamps occur twice"
        raise LogError(
            cause,
            evidence={
                "backward_steps": self._backwards,
                "duplicate_stamps": self._duplicates,
                "first_row": row,
                "stamps_s": [before, after],
            },
            remedy="check that the column of time is the recorder's clock; the rows follow neither their "
            "stamps nor, in runs, each other"
            if self._backwards
            else "keep one row per stamp; where rounding made the stamps alike, "
            '"time": null with the true "rate_hz" stands for them',
        )

    def _check_alive(self) -> None:
        if not np.any(self.high["position"] > self.low["position"]):
            raise LogError(
                "no joint ever moves: every position is constant",
                evidence={"positions": [float(value) for value in self.low["position"]]},
                remedy="log a motion that moves every joint",
            )
        effort = next(name for name in EFFORTS if name in self.low)
        if not np.any(self.low[effort]) and not np.any(self.high[effort]):
            raise LogError(
                f"the {effort} is zero throughout on every joint",
                evidence={"columns": list(self._columns[effort])},
                remedy=f'log the measured {effort}, or leave it out by "{effort}": null in the mapping',
            )
