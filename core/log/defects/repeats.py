"""Find rows that repeat the row before exactly, as a recorder writes them when it has missed a sample.

Positions and torques together carry noise, so that an exact repeat is a copy and not a coincidence.
"""

import numpy as np

from core.log.defects.runs import Runs
from core.log.defects.stretch import Facts, Stretch, repeats_previous
from core.log.model import Defect

NOTICED = 1e-3
"""A smaller share of repeated rows is not worth a word."""


class Repeats:
    """Count the rows whose positions and torques repeat the row before."""

    def __init__(self) -> None:
        self._runs = Runs()

    def see(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        same = repeats_previous(stretch.position[:, stretch.seam :])
        effort = stretch.others.get("current") if stretch.torque is None else stretch.torque
        if effort is not None and np.any(same):
            same &= repeats_previous(effort[:, stretch.seam :])
        self._runs.feed(same, stretch.time[stretch.seam + 1 :])

    def defects(self, facts: Facts) -> list[Defect]:
        """State the share of repeated rows."""
        self._runs.close()
        rows = self._runs.rows
        if rows <= NOTICED * facts.samples:
            return []
        statement = (
            f"{rows} of {facts.samples} rows ({100.0 * rows / facts.samples:.2g} %) repeat the positions and "
            "torques of the row before exactly."
        )
        return [Defect("repeated_rows", "position", None, rows, self._runs.intervals, statement)]
