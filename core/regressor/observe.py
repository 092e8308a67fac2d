"""Write down all equations of a study, and keep only their factors: W of a long log is never stored.

Per joint and per contiguous block of every log one triangular factor is kept, plus per joint the lagged
products that tell how far the residual's memory inflates a variance. Blocks are what hold-out and bootstrap
choose from.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from itertools import repeat
from typing import Protocol, TypeVar, runtime_checkable

import numpy as np

from ..arrays import BlockKey, Indices, JointSeries, JointVector
from ..errors import OptionError
from ..signals.parallel import Tile
from .block import Block, OpenBlock, Tail, groups_of
from .columns import ColumnPlan
from .factor import INSTRUMENT, Factor, FilteredRows, Weigh
from .memory import LaggedProducts, TurningProducts

_POSITIONS_PER_BLOCK = 32
_UNMARKED = np.zeros(0, dtype=bool)
Products = TypeVar("Products")
Progress = Callable[[float], None]


@runtime_checkable
class Tiled(Protocol):
    """Give motion tile by tile, as it was measured or otherwise known."""

    @property
    def kept(self) -> int:
        """Count the decimated samples."""

    def tiles(self) -> Iterator[Tile]:
        """Go through the motion once."""


@dataclass(frozen=True, eq=False)
class Observation:
    """Hold the equations of a study over chosen columns of a model."""

    plan: ColumnPlan
    """The model and its columns."""
    blocks: tuple[Block, ...]
    columns_of: tuple[Indices, ...]
    """Per joint, the positions in `plan.columns` that its factors run over."""
    memory: tuple[LaggedProducts, ...]
    """Per joint, the lagged products of its rows."""
    turning_memory: tuple[TurningProducts, ...]
    """Per joint, those of them that rows beside a reversal have a part in."""
    positions: JointSeries
    """A sample of the positions along the motions, rad or m."""
    kept: int
    """Number of decimated samples; a joint's factors have fewer rows where instants were unusable for it."""
    instruments: bool = False
    """Whether the rows are [z w y]: with instruments before the columns."""

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
            for joint, groups in enumerate(groups_of(self.plan, instruments=self.instruments))
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
    *,
    held_out: frozenset[BlockKey] = frozenset(),
    progress: Progress | None = None,
    weigh: Weigh | None = None,
    instruments: tuple[Tiled, ...] = (),
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
    instruments
        The same motions otherwise known, tile by tile: their columns stand before the motions' own. None by
        default.
    """
    beside = bool(instruments)
    gathered = [_Gathering(plan, weigh, held_out, number, beside=beside) for number in range(len(motions))]
    total = _take_all(motions, instruments, gathered, progress)
    blocks = tuple(block for gathering in gathered for block in gathering.blocks())
    memory = _merged_by_joint(LaggedProducts.merged, [gathering.memory for gathering in gathered])
    turning = _merged_by_joint(TurningProducts.merged, [gathering.turning for gathering in gathered])
    positions = np.vstack([position for gathering in gathered for position in gathering.positions])
    return Observation(plan, blocks, plan.columns_of, memory, turning, positions, total, beside)


def _take_all(
    motions: tuple[Tiled, ...],
    instruments: tuple[Tiled, ...],
    gathered: list["_Gathering"],
    progress: Progress | None,
) -> int:
    """Let every motion's tiles be gathered, and count the instants."""
    total, done = sum(motion.kept for motion in motions), 0
    for number, (motion, gathering) in enumerate(zip(motions, gathered, strict=True)):
        others = instruments[number].tiles() if instruments else repeat(None)
        for tile, other in zip(motion.tiles(), others, strict=False):
            gathering.take(tile, other)
            done += len(tile.time)
            if progress is not None:
                progress(done / total)
    return total


def equations(plan: ColumnPlan, tile: Tile) -> Iterator[FilteredRows]:
    """Give, joint by joint, the filtered rows [W y] of a tile with the mask of usable ones."""
    if plan.is_instantaneous:
        filtered = tile.filtered_in_parts(plan.series)
    else:
        filtered = tile.filtered(plan.series(tile.state))
    torque = tile.filtered(np.ascontiguousarray(tile.torque.T))
    for joint, rows in enumerate(plan.rows_of):
        yield np.vstack([filtered[rows], torque[joint]]).T, tile.usable[:, joint]


def _equations_of(plan: ColumnPlan, tile: Tile, other: Tile | None) -> Iterator[FilteredRows]:
    """Give the rows [w y] of a tile, or [z w y] with the columns of another one as instruments."""
    if other is None:
        yield from equations(plan, tile)
        return
    pairs = zip(equations(plan, tile), equations(plan, other), strict=True)
    for (rows, usable), (instruments, _) in pairs:
        yield np.hstack([instruments[:, :-1], rows]), usable


class _Gathering:
    """Collect the tiles of one motion, block by block."""

    def __init__(
        self, plan: ColumnPlan, weigh: Weigh | None, held_out: frozenset[BlockKey], log: int, *, beside: bool
    ) -> None:
        self.plan = plan
        self.groups = groups_of(plan, instruments=beside)
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
        self.positions: list[JointSeries] = []

    def take(self, tile: Tile, other: Tile | None = None) -> None:
        if not tile.follows:
            self._tails = [tail.none for tail in self._tails]
        parts = list(tile.parts())
        for number, kept in parts:
            self._sample(tile, kept)
            block = self._blocks.setdefault(number, OpenBlock(self.groups, float(tile.time[kept.start])))
            block.end = float(tile.time[kept.stop - 1])
        pairs = list(self.plan.combined(tile, _equations_of(self.plan, tile, other)))
        weights = None if self.weigh is None else self.weigh(pairs)
        fitted = ~np.isin(tile.block, self.held_out)
        for joint, (rows, usable) in enumerate(pairs):
            marked = rows * (usable if weights is None else usable * weights[joint])[:, None]
            moving, turning = usable & ~tile.turning[:, joint], tile.turning[:, joint]
            for number, kept in parts:
                split = marked[kept][moving[kept]], marked[kept][turning[kept]]
                self._blocks[number].take(joint, split, rows[kept, -1][usable[kept]])
            self._remember(joint, marked * fitted[:, None], turning & fitted, int((usable & fitted).sum()))

    def _sample(self, tile: Tile, kept: slice) -> None:
        """Keep some of a block's positions."""
        step = 1 + (kept.stop - kept.start) // _POSITIONS_PER_BLOCK
        at = tile.first + tile.parallel.decimation * np.arange(kept.start, kept.stop, step)
        self.positions.append(tile.state.position[at[:_POSITIONS_PER_BLOCK]])

    def _remember(self, joint: int, rows: np.ndarray, turning: np.ndarray, used: int) -> None:
        tail = self._tails[joint]
        self.memory[joint] = self.memory[joint].extended(tail.rows, rows, used)
        joined = Tail(np.vstack([tail.rows, rows]), np.append(tail.turning, turning))
        self.turning[joint] = self.turning[joint].extended(joined.rows, joined.turning, len(tail.rows))
        self._tails[joint] = joined.last

    def blocks(self) -> list[Block]:
        return [self._blocks[number].closed(self.log, number) for number in sorted(self._blocks)]


def torque_scales(observation: Observation, chosen: tuple[int, ...] | None = None) -> JointVector:
    """Give the RMS of the filtered torque per joint over the chosen blocks (all by default), N m."""
    factors = observation.joint_factors(chosen)
    return np.array([np.sqrt(factor.torque_square / max(factor.rows, 1)) for factor in factors])
