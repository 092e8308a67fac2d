"""Find rows at an end of a log that do not belong to its motion.

A recorder writes zeros, a stale sample or stamps of another clock before its first message arrives, and after
its last. A motion of limited bandwidth, sampled well, changes its increments little from one row to the next.
A position that gets far in one step, and not on in the next, is no motion: the largest second difference of
the log itself is the measure. Of such an end nothing is usable, and a filter would be laid through its jump.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import InstantMask, InstantSeries, JointSeries, JointVector, Samples
from ..channels import EFFORTS
from ..defects.stretch import GRID_STEPS, JUMP_FACTOR, USUAL_SHARE
from ..model import STANDING_ROWS, LogRows

FEWEST_ROWS = 100
"""Fewer rows than these have no body that an end could be compared with."""
ISOLATED = 4.0
"""The second difference of a jump is so many times the two that follow."""
DISPLACED = 0.55
"""The step into the body makes at least so much of it; where a motion starts or turns round in an instant, it
makes nothing or half."""
SMALLEST_SHARE = 1e-3
"""Of the range: smaller jumps are noise to everything that follows."""
DISORDER = 0.01
"""Where the stamps of more rows than this share do not advance, it is no matter of the ends."""
SPIKE_ROWS = 2
"""So many rows apart from those on either side are a spike, which the median filter removes."""


@dataclass(frozen=True)
class BadEnd:
    """Say how many rows of an end do not belong, and why, as the end of a sentence."""

    rows: int
    channel: str
    why: str


def bad_head(rows: LogRows) -> BadEnd | None:
    """Judge the first rows of a stretch; None where they belong to the motion.

    Examples
    --------
    >>> time = np.arange(500) / 250.0
    >>> swing = np.sin(3.0 * time + 1.0)[:, None]
    >>> torque = 5.0 * swing
    >>> swing[:2] = torque[:2] = 0.0
    >>> bad_head(LogRows(time, swing, torque)).rows
    2
    """
    if len(rows.time) < FEWEST_ROWS:
        return None
    effort, start, found = _effort(rows), 0, None
    while len(rows.time) - start >= FEWEST_ROWS:
        time, position, torque = rows.time[start:], rows.position[start:], effort[start:]
        new = (
            _other_clock(time) or _far_position(position) or _idle_effort(torque) or _copies(position, torque)
        )
        if new is None:
            break
        start += new.rows
        found = BadEnd(start, new.channel if found is None else found.channel, new.why)
    return found


def bad_tail(rows: LogRows) -> BadEnd | None:
    """Judge the last rows of a stretch, which are the first of the motion run backwards."""
    backwards = {name: values[::-1] for name, values in rows.channels().items()}
    return bad_head(LogRows(-rows.time[::-1], **backwards))


def is_mostly_held(rows: LogRows) -> bool:
    """Tell whether more than half of some rows say the same as the first: their end may be farther on.

    Examples
    --------
    >>> is_mostly_held(LogRows(np.arange(9.0), np.zeros((9, 1)), np.arange(9.0)[:, None]))
    True
    """
    channels = (rows.time[:, None], rows.position, _effort(rows))
    return any(_held_rows(values) > len(values) // 2 for values in channels)


def _effort(rows: LogRows) -> JointSeries:
    """Give the effort that is used, by which an end is judged."""
    return next(getattr(rows, name) for name in EFFORTS if getattr(rows, name) is not None)


def _other_clock(time: Samples) -> BadEnd | None:
    """Find stamps that stand still, go backwards or are farther from the rest than the rest is long."""
    steps = np.diff(time)
    rest = time[-1] - time[1:]
    breaks = np.flatnonzero((steps <= 0.0) | (steps > rest))
    standing = int(np.argmax(steps != 0.0)) + 1 if np.any(steps != 0.0) else 0
    early = [int(row) + 1 for row in breaks if row < STANDING_ROWS or row + 1 == standing]
    early = [row for row in early if row <= len(time) // 2]
    if not early or np.mean(steps[max(early) :] <= 0.0) > DISORDER:
        return None
    row = max(early)
    why = f"the stamp {abs(time[row - 1]):.10g} s is followed by {abs(time[row]):.10g} s"
    return BadEnd(row, "time", why)


def _far_position(position: JointSeries) -> BadEnd | None:
    jumps, times, least = _jumps(position)
    held = _held_rows(position)
    steps = (int(step) + 1 for step in np.flatnonzero(jumps.any(axis=1)))
    early = [row for row in steps if row <= STANDING_ROWS or row == held]
    early = [row for row in early if not _goes_on(position[: row + 2], row, least)]
    if not early:
        return None
    row = max(early)
    joint = int(np.argmax(np.where(jumps[row - 1], times[row - 1], 0.0)))
    step = abs(position[row, joint] - position[row - 1, joint])
    why = (
        f"joint {joint + 1}'s position is {step:.3g} (rad or m) from the next row's, a step whose second "
        f"difference is {times[row - 1, joint]:.3g} times what the motion's stay below"
    )
    return BadEnd(row, "position", why)


def _goes_on(position: JointSeries, row: int, least: JointVector) -> bool:
    """Tell whether some row before leads on to this one: what lies between is a spike, and no bad end."""
    back = np.arange(min(row, SPIKE_ROWS + 1), 0, -1)[:, None]
    expected = position[row] - back * (position[row + 1] - position[row])
    far = np.abs(position[row - len(back) : row] - expected) > least * (1.0 + 0.5 * back**2)
    return not bool(np.all(far.any(axis=1)))


def _idle_effort(effort: JointSeries) -> BadEnd | None:
    """Find torques (currents) that are all zero, or all held for some rows, before they jump."""
    held = _held_rows(effort)
    zero = not np.any(effort[0])
    if not (zero or 1 < held <= STANDING_ROWS) or not 0 < held < len(effort) // 2:
        return None
    jumps, times, _ = _jumps(effort)
    if not jumps[held - 1].any():
        return None
    what = "zero on every joint" if zero else "the same on every joint"
    why = f"torque or current is {what} and then jumps, by {times[held - 1].max():.3g} times its usual change"
    return BadEnd(held, "torque", why)


def _copies(position: JointSeries, effort: JointSeries) -> BadEnd | None:
    """Find copies of one row, from which the motion goes on in an instant: nothing was measured there.

    A joint that truly stands starts from rest: its second differences stay as large while it speeds up, and
    its torque carries noise.
    """
    held = min(_held_rows(position), _held_rows(effort))
    if not 1 < held < len(position) - 3:
        return None
    bends, usual, least = _bends(position, smallest=0.0)
    bend, onward = bends[held - 2], np.max(bends[held - 1 : held + 1], axis=0)
    jumps = (bend > least) & (bend > ISOLATED * onward)
    if not jumps.any():
        return None
    joint = int(np.argmax(np.where(jumps, bend / usual, 0.0)))
    why = (
        f"they are copies of one row, and joint {joint + 1} moves on from it in an instant, with a second "
        f"difference {bend[joint] / usual[joint]:.3g} times what the motion's stay below"
    )
    return BadEnd(held - 1, "file", why)


def _held_rows(values: JointSeries) -> int:
    """Count the first rows that equal the first one on every joint."""
    differ = np.any(values != values[0], axis=1)
    return int(np.argmax(differ)) if differ.any() else len(values)


def _jumps(values: JointSeries) -> tuple[InstantMask, InstantSeries, JointVector]:
    """Mark the steps that no motion makes, say how many times what is usual each is, and what is least."""
    steps = np.abs(np.diff(values, axis=0))
    bends, usual, least = _bends(values)
    own, onward = bends[:-2], np.maximum(bends[1:-1], bends[2:])
    jumps = (own > least) & (own > ISOLATED * onward) & (steps[:-3] > DISPLACED * own)
    return jumps, own / usual, least


def _bends(
    values: JointSeries, smallest: float = SMALLEST_SHARE
) -> tuple[InstantSeries, JointVector, JointVector]:
    """Give the second differences, what those of the motion stay below, and what is least to be a jump."""
    steps = np.abs(np.diff(values, axis=0))
    bends = np.abs(np.diff(values, n=2, axis=0))
    body = max(len(bends) // 4, min(_held_rows(values), len(bends) - FEWEST_ROWS))
    usual = np.quantile(bends[body:], USUAL_SHARE, axis=0)
    grid = np.min(np.where(steps > 0.0, steps, np.inf), axis=0, initial=np.inf)
    span = np.ptp(values[body:], axis=0)
    least = np.maximum(JUMP_FACTOR * usual, smallest * span)
    least = np.maximum(least, np.where(np.isfinite(grid), GRID_STEPS * grid, np.inf))
    resolved = np.maximum(np.finfo(float).eps * np.ptp(values, axis=0), np.finfo(float).tiny)
    return bends, np.maximum(usual, resolved), least
