"""Write down all equations of a study, and keep only their factors: W of a long log is never stored.

Per joint and per contiguous block of every log one triangular factor is kept, plus per joint the lagged
products that tell how far the residual's memory inflates a variance. Blocks are what hold-out and bootstrap
choose from.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from typing import TypeVar

import numpy as np

from ..arrays import BlockKey, EquationRows, Indices, JointSeries, JointVector, Weights
from ..errors import OptionError
from ..signals.parallel import Tile
from .block import Block, OpenBlock, Tail
from .columns import ColumnPlan
from .factor import INSTRUMENT, Factor, FilteredRows, Groups, Weigh
from .memory import LaggedProducts, TurningProducts
from .rows import MeasuredRows, RowSource, Tiled

_POSITIONS_PER_BLOCK = 32
_UNMARKED = np.zeros(0, dtype=bool)
Products = TypeVar("Products")
Progress = Callable[[float], None]


@dataclass(frozen=True, eq=False)
class Observation:
    """Hold the equations of a study over chosen columns of a model."""

    plan: ColumnPlan
    """The model and its columns."""
    blocks: tuple[Block, ...]
    columns_of: tuple[Indices, ...]
    """Per joint, the positions in `plan.columns` that its factors run over."""
    groups: tuple[Groups, ...]
    """Per joint, what the columns of its factors are."""
    memory: tuple[LaggedProducts, ...]
    """Per joint, the lagged products of its rows."""
    turning_memory: tuple[TurningProducts, ...]
    """Per joint, those of them that rows beside a reversal have a part in."""
    positions: JointSeries
    """A sample of the positions along the motions, rad or m."""
    kept: int
    """Number of decimated samples; a joint's factors have fewer rows where instants were unusable for it."""

    def joint_factors(self, chosen: tuple[int, ...] | None = None) -> tuple[Factor, ...]:
        """Merge the factors of the chosen blocks (all by default), one per joint."""
        return self._merged([block.factors for block in self._picked(chosen)])

    def moving_factors(self, chosen: tuple[int, ...] | None = None) -> tuple[Factor, ...]:
        """Give the same of the rows in which the direction of the joint's friction is known."""
        return self._merged([block.moving for block in self._picked(chosen)])

    def turning_factors(self, chosen: tuple[int, ...] | None = None) -> tuple[Factor, ...]:
        """Give the same of the rows beside a reversal."""
        return self._merged([block.turning for block in self._picked(chosen)])

    def scored_factors(self, chosen: tuple[int, ...]) -> tuple[Factor, ...]:
        """Give the rows that a model can be judged by: the moving ones; all of a joint that has none."""
        pairs = zip(self.moving_factors(chosen), self.turning_factors(chosen), strict=True)
        return tuple(moving if moving.rows else turning for moving, turning in pairs)

    def _picked(self, chosen: tuple[int, ...] | None) -> tuple[Block, ...]:
        return self.blocks if chosen is None else tuple(self.blocks[index] for index in chosen)

    def _merged(self, blocks: list[tuple[Factor, ...]]) -> tuple[Factor, ...]:
        return tuple(
            Factor.empty(sum(dict(groups).values()), groups).merged(*(block[joint] for block in blocks))
            for joint, groups in enumerate(self.groups)
        )

    def parts(self, held_out: frozenset[BlockKey]) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Give the indices of the fitted and of the held-out blocks.

        Raises
        ------
        OptionError
            If blocks are held out, but none of them has an instant to judge by.
        """
        fitted: list[int] = []
        held: list[int] = []
        for index, block in enumerate(self.blocks):
            (held if (block.log, block.number) in held_out else fitted).append(index)
        if held_out and not any(factor.rows for index in held for factor in self.blocks[index].factors):
            raise OptionError(
                "no sample used lies in the held-out blocks",
                evidence={"instants kept": self.kept, "blocks held out": len(held_out)},
                remedy="use more samples (smaller decimation, longer log), or hold out longer blocks",
            )
        return tuple(fitted), tuple(held)

    def over(self, plan: ColumnPlan, indices: Indices) -> "Observation":
        """Give the equations of a plan all of whose columns are among this one's, without another pass.

        Parameters
        ----------
        indices
            Rising positions of the plan's columns in `self.plan.columns`.
        """
        kept = [
            np.append(np.searchsorted(own, indices[wanted]), len(own))
            for own, wanted in zip(self.columns_of, plan.columns_of, strict=True)
        ]

        def fewer(block: Block) -> Block:
            moving, turning = (
                tuple(factor.over(own) for factor, own in zip(factors, kept, strict=True))
                for factors in (block.moving, block.turning)
            )
            return replace(block, moving=moving, turning=turning)

        return replace(
            self,
            plan=plan,
            blocks=tuple(fewer(block) for block in self.blocks),
            columns_of=plan.columns_of,
            groups=MeasuredRows(plan).groups,
            memory=tuple(products.over(own) for products, own in zip(self.memory, kept, strict=True)),
            turning_memory=tuple(
                products.over(own) for products, own in zip(self.turning_memory, kept, strict=True)
            ),
        )


def _merged_by_joint(
    merge: Callable[[Products, Products], Products], motions: Sequence[Sequence[Products]]
) -> tuple[Products, ...]:
    """Merge what every motion has gathered, joint by joint."""
    return tuple(reduce(merge, of_joint) for of_joint in zip(*motions, strict=True))


def observe(
    plan: ColumnPlan,
    motions: tuple[Tiled, ...],
    held_out: frozenset[BlockKey] = frozenset(),
    *,
    progress: Progress | None = None,
    weigh: Weigh | None = None,
    rows: RowSource | None = None,
) -> Observation:
    """Accumulate the equations of all motions.

    Parameters
    ----------
    plan
        Model and columns.
    held_out
        (log, block) pairs that are condensed for validation but kept out of the residual's memory.
    progress
        Called with the fraction done.
    weigh
        For robust fits: gives the weights of a tile's rows.
    rows
        What the equations are; the columns of the motions by default.
    """
    source: RowSource = MeasuredRows(plan) if rows is None else rows
    gathered = [_Gathering(source.groups, weigh, held_out, number) for number in range(len(motions))]
    total = _take_all(motions, source, gathered, progress)
    blocks = tuple(block for gathering in gathered for block in gathering.blocks())
    memory = _merged_by_joint(LaggedProducts.merged, [gathering.memory for gathering in gathered])
    turning = _merged_by_joint(TurningProducts.merged, [gathering.turning for gathering in gathered])
    positions = np.vstack([gathering.positions for gathering in gathered])
    return Observation(plan, blocks, source.columns_of, source.groups, memory, turning, positions, total)


def _take_all(
    motions: tuple[Tiled, ...], source: RowSource, gathered: list["_Gathering"], progress: Progress | None
) -> int:
    """Let every motion's tiles be gathered, and count the instants."""
    total, done = sum(motion.kept for motion in motions), 0
    for number, (motion, gathering) in enumerate(zip(motions, gathered, strict=True)):
        for tile, rows in source.rows(number, motion):
            gathering.take(tile, rows)
            done += len(tile.time)
            if progress is not None:
                progress(done / total)
    return total


class _Gathering:
    """Collect the tiles of one motion, block by block."""

    def __init__(
        self, groups: tuple[Groups, ...], weigh: Weigh | None, held_out: frozenset[BlockKey], log: int
    ) -> None:
        self.groups = groups
        self.weigh = weigh
        self.held_out = [number for source, number in held_out if source == log]
        self.log = log
        widths = [dict(own) for own in self.groups]
        totals = [sum(own.values()) for own in widths]
        self.memory = [
            LaggedProducts.empty(total, own.get(INSTRUMENT, 0))
            for total, own in zip(totals, widths, strict=True)
        ]
        self.turning = [TurningProducts.empty(total) for total in totals]
        self._tails = [Tail(np.zeros((0, total)), _UNMARKED) for total in totals]
        self._blocks: dict[int, OpenBlock] = {}
        self._positions: list[JointSeries] = []

    def take(self, tile: Tile, pairs: list[FilteredRows]) -> None:
        if not tile.follows:
            self._tails = [tail.none for tail in self._tails]
        parts = list(tile.parts())
        for number, kept in parts:
            self._sample(tile, kept)
            block = self._blocks.setdefault(number, OpenBlock(self.groups, float(tile.time[kept.start])))
            block.end = float(tile.time[kept.stop - 1])
        weights = None if self.weigh is None else self.weigh(pairs)
        fitted = ~np.isin(tile.block, self.held_out)
        for joint, (rows, usable) in enumerate(pairs):
            marked = _times(rows, usable if weights is None else usable * weights[joint])
            moving, turning = usable & ~tile.turning[:, joint], tile.turning[:, joint]
            for number, kept in parts:
                split = marked[kept][moving[kept]], marked[kept][turning[kept]]
                self._blocks[number].take(joint, split, rows[kept, -1][usable[kept]])
            self._remember(joint, _times(marked, fitted), turning & fitted, int((usable & fitted).sum()))

    def _sample(self, tile: Tile, kept: slice) -> None:
        """Keep some of a block's positions."""
        step = 1 + (kept.stop - kept.start) // _POSITIONS_PER_BLOCK
        at = tile.first + tile.parallel.decimation * np.arange(kept.start, kept.stop, step)
        self._positions.append(tile.state.position[at[:_POSITIONS_PER_BLOCK]])

    def _remember(self, joint: int, rows: np.ndarray, turning: np.ndarray, used: int) -> None:
        tail = self._tails[joint]
        joined = Tail(np.vstack([tail.rows, rows]), np.append(tail.turning, turning))
        self.memory[joint] = self.memory[joint].extended(joined.rows, len(tail.rows), used)
        self.turning[joint] = self.turning[joint].extended(joined.rows, joined.turning, len(tail.rows))
        self._tails[joint] = joined.last

    @property
    def positions(self) -> JointSeries:
        return np.vstack(self._positions)

    def blocks(self) -> list[Block]:
        return [self._blocks[number].closed(self.log, number) for number in sorted(self._blocks)]


def _times(rows: EquationRows, weights: Weights) -> EquationRows:
    """Multiply rows by their weights, where these are not all one."""
    return rows if (weights == 1.0).all() else rows * weights[:, None]


def torque_scales(observation: Observation, chosen: tuple[int, ...] | None = None) -> JointVector:
    """Give the RMS of the filtered torque per joint over the chosen blocks (all by default), N m."""
    factors = observation.joint_factors(chosen)
    return np.array([np.sqrt(factor.torque_square / max(factor.rows, 1)) for factor in factors])
