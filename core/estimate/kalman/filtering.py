"""Carry a Kalman filter through logs, and take what it learns of the parameters as equations, per block.

Without drift the information of the parameters grows only by what was measured. What a block adds, given all
before, is a least-squares problem over the parameters: ||T chi - z||^2 with T'T the added information and T'z
the same times what it says. The sum over blocks is what the filter knows at its end, less where it began.
Held-out blocks and gaps are passed over: after them positions and velocities begin anew, parameters go on.
"""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import solve_triangular

from ...arrays import BaseParameters, BlockKey, JointVector, Mask, Matrix, SquareMatrix, Vector
from ...errors import ExcitationError, SolverError
from ...regressor.factor import Factor
from ...signals.condition import Motion
from ...simulation.filter.state_filter import FilterState, StateFilter
from .filter_input import Stretch, filter_of_segment, stretches
from .filter_start import FilterStart
from .innovations import Track

MOST_SHORTENED = 0.01
"""Share of samples at which parameters may have to differ by less than their deviations, so that the mass
matrix stays positive."""
NARROWER = (1.0, 0.3, 0.1)
"""Shares of `kalman.start_scale` with which a filter begins, one after the other until it follows."""
DRIFT_SECONDS = 0.1
"""Parameters drift in steps that are so far apart, s."""
_TOLERANCE = 1e-12


@dataclass(frozen=True, eq=False)
class Known:
    """Hold what a filter knows of the parameters at an instant, s, and what it took in since the last."""

    key: BlockKey
    time: float
    values: BaseParameters
    factor: SquareMatrix
    """Upper triangle U of their covariance U'U."""
    squares: JointVector
    """Per joint, the sum of squares of what was not foreseen of the positions, in its deviations."""
    samples: int
    shortened: int
    """Samples, and those of them at which parameters had to differ by less."""

    def after(self, earlier: "Known") -> "Known":
        """Count what was taken in before, too."""
        return replace(
            self,
            squares=self.squares + earlier.squares,
            samples=self.samples + earlier.samples,
            shortened=self.shortened + earlier.shortened,
        )


@dataclass(frozen=True, eq=False)
class Followed:
    """Hold what a filter knew at its start and after every block."""

    start: FilterStart
    position_noise: JointVector
    """Largest deviation of the positions in any log, rad or m."""
    blocks: tuple[Known, ...]

    @cached_property
    def whole(self) -> Known:
        """Give what it knows at its end, and all that it has taken in."""
        whole = self.blocks[0]
        for known in self.blocks[1:]:
            whole = known.after(whole)
        return whole

    @property
    def innovation(self) -> JointVector:
        """Give, per joint, the mean square of what was not foreseen of the positions, in its deviations."""
        return self.whole.squares / self.whole.samples

    @property
    def track(self) -> Track:
        """Give the parameters over time, with the deviations that the filter expects."""
        return Track(
            tuple(known.key[0] for known in self.blocks),
            np.array([known.time for known in self.blocks]),
            np.array([known.values for known in self.blocks]),
            np.array([np.linalg.norm(known.factor, axis=0) for known in self.blocks]),
        )

    @cached_property
    def factors(self) -> tuple[Factor, ...]:
        """Give every block's equations."""
        values, factor = self.start.values, self.start.factor
        found, moving = list[Factor](), np.diag(self.whole.factor) != 0.0
        for known in self.blocks:
            found.append(_gained(values, factor, known, self.whole.factor, moving))
            values, factor = known.values, known.factor
        return tuple(found)


def follow(
    start: FilterStart,
    motions: tuple[Motion, ...],
    held_out: frozenset[BlockKey],
    drift: Vector | None = None,
) -> Followed:
    """Filter as `filter_once` does, and again from a narrower start where the filter loses the robot.

    What a start says of the parameters is in no equation, so that a narrower one takes nothing from them.

    Raises
    ------
    SolverError, ExcitationError
        If the narrowest start is too wide as well.
    """
    *wider, narrowest = (start.narrowed(share) for share in NARROWER)
    for own in wider:
        with suppress(ExcitationError, SolverError):
            return filter_once(own, motions, held_out, drift)
    return filter_once(narrowest, motions, held_out, drift)


def filter_once(
    start: FilterStart,
    motions: tuple[Motion, ...],
    held_out: frozenset[BlockKey],
    drift: Vector | None = None,
) -> Followed:
    """Filter the fitted blocks of motions one after the other.

    Parameters
    ----------
    drift
        Per parameter, the deviation of its random walk per square root of a second; None for none.

    Raises
    ------
    SolverError
        If parameters within their deviations are often no robot, or the filter diverges.
    ExcitationError
        If it diverges where the motion does not separate the parameters.
    """
    blocks: dict[BlockKey, Known] = {}
    try:
        for known in _known(start, motions, held_out, drift):
            blocks[known.key] = known.after(blocks[known.key]) if known.key in blocks else known
    except SolverError as error:
        if start.separates:
            raise
        raise ExcitationError(
            "the filter lost the robot, because the motion does not separate its parameters",
            evidence=error.evidence,
            remedy="record a motion in which every joint moves, or fit with sdp, which names what is open",
        ) from error
    noise = np.max([np.sqrt(start.variance(motion)) for motion in motions], axis=0)
    found = Followed(start, noise, tuple(blocks.values()))
    whole = found.whole
    if whole.shortened > MOST_SHORTENED * whole.samples:
        raise SolverError(
            "parameters within their deviations are often no robot, which no filter can foresee",
            evidence={"samples": whole.samples, "shortened": whole.shortened},
            remedy="give kalman a smaller start_scale, or fit with didim",
        )
    return found


def _known(
    start: FilterStart, motions: tuple[Motion, ...], held_out: frozenset[BlockKey], drift: Vector | None
) -> Iterator[Known]:
    values, factor = start.values, start.factor
    own: StateFilter | None = None
    for log, motion in enumerate(motions):
        for part in stretches(log, motion, held_out):
            if own is None or part.begins:
                own = filter_of_segment(start, motion, part.segment)
                state = part.begun(own, values, factor)
            squares, state, shortened = _run(own, state, part, start, drift)
            values, factor = own.known(state)
            time = float(part.tile.time[part.kept.stop - 1])
            yield Known(part.key, time, values, factor, squares, part.count, shortened)


def _run(
    own: StateFilter, state: FilterState, part: Stretch, start: FilterStart, drift: Vector | None
) -> tuple[JointVector, FilterState, int]:
    """Take a stretch in, in pieces where the parameters drift."""
    torque, step = part.torque(own), own.clock.step
    samples = part.position, torque, part.noise(start, torque)
    length = part.count if drift is None else max(1, round(DRIFT_SECONDS / step))
    squares, before = np.zeros(samples[0].shape[1]), state.shortened
    for begin in range(0, part.count, length):
        piece = tuple(series[begin : begin + length] for series in samples)
        if drift is not None:
            state = state.drifted(np.sqrt(step * len(piece[0])) * drift)
        missed, state = own.run(state, *piece)
        squares += np.sum(missed**2, axis=0)
    return squares, state, state.shortened - before


def _gained(
    values: BaseParameters, factor: SquareMatrix, known: Known, last: SquareMatrix, moving: Mask
) -> Factor:
    """Give what was learned of parameters since there were these values.

    The equations are written for x of unit covariance at last, chi = values + unit x, so that what is learned
    in a block is compared with all that is learned.
    """
    index = np.ix_(moving, moving)
    unit = last[index].T
    old, new = (_whitened(own[index], unit) for own in (factor, known.factor))
    way = solve_triangular(unit, (known.values - values)[moving], lower=True)
    size, vectors = np.linalg.eigh(new.T @ new - old.T @ old)
    learned = size > _TOLERANCE
    root, vectors = np.sqrt(size[learned]), vectors[:, learned]
    target = vectors.T @ (new.T @ (new @ way)) / root
    rows = solve_triangular(unit, vectors * root, lower=True, trans="T").T
    missed = target - root * (vectors.T @ way)
    rest = known.squares.sum() - np.sum((old @ way) ** 2) - missed @ missed
    width = len(moving) + 1
    table = np.zeros((len(root) + 1 + width, width))
    table[: len(root), np.append(moving, False)] = rows
    table[: len(root), -1] = target + rows @ values[moving]
    table[len(root), -1] = np.sqrt(max(float(rest), 0.0))
    return replace(Factor.of(table), rows=known.samples * len(known.squares))


def _whitened(factor: SquareMatrix, unit: Matrix) -> Matrix:
    """Give rows whose squares are the information of x about chi = unit x of covariance factor' factor."""
    return np.asarray(solve_triangular(factor, unit, trans="T"))
