"""Set blocks aside before anything is fitted: contiguous stretches, or whole logs, never shuffled samples.

Neighbouring samples share noise and motion, so a shuffled hold-out is no hold-out at all. Source: Roberts et
al., Ecography 2017.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import BlockKey
from ..errors import OptionError


@dataclass(frozen=True)
class HoldOut:
    """Ask for held-out data."""

    fraction: float = 0.2
    """Share of each log's blocks that is held out; 0 for none."""
    blocks: int = 20
    """Number of blocks each log is divided into."""
    logs: tuple[int, ...] = ()
    """Numbers of logs, from 1, that are held out whole; then `fraction` does not apply."""

    def __post_init__(self) -> None:
        """Refuse hold-outs that leave nothing to fit or nothing to divide."""
        if not 0.0 <= self.fraction <= 0.5 or not 4 <= self.blocks <= 200:
            raise OptionError(
                "the hold-out is not valid",
                evidence={"fraction": self.fraction, "blocks": self.blocks},
                remedy="hold out a fraction from 0 to 0.5 of 4 to 200 blocks",
            )

    def chosen(self, logs: int) -> frozenset[BlockKey]:
        """Pick the held-out blocks, spread evenly over each log.

        Examples
        --------
        >>> sorted(HoldOut(fraction=0.25, blocks=8).chosen(1))
        [(0, 2), (0, 6)]
        """
        if self.logs:
            self._check(logs)
            return frozenset((log - 1, block) for log in self.logs for block in range(self.blocks))
        count = round(self.fraction * self.blocks)
        if not count:
            return frozenset()
        held_out = ((np.arange(count) + 0.5) * self.blocks / count).astype(int)
        return frozenset((log, int(block)) for log in range(logs) for block in held_out)

    def _check(self, logs: int) -> None:
        if logs == 1:
            raise OptionError(
                "a single log cannot be held out whole, because nothing would be left to fit",
                evidence={"held_out": list(self.logs), "logs": logs},
                remedy="hold out a fraction of its blocks instead, or give a second log",
            )
        if any(not 1 <= log <= logs for log in self.logs) or len(set(self.logs)) >= logs:
            raise OptionError(
                "the held-out logs leave nothing to fit or do not exist",
                evidence={"held_out": list(self.logs), "logs": logs},
                remedy=f"name logs from 1 to {logs} and leave at least one to fit",
            )
