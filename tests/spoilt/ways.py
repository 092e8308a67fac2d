"""Spoil the values of a log's rows, as recorders, set-ups and drives do, drawn from a seed.

A way that is a cause by itself says so: a torque that is cut off is saturation. Whatever else is named is
false. Every way leaves a table that a file can hold.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from veritorque.core.log.model import LogRows

CAUSELESS: frozenset[str] = frozenset()


@dataclass(frozen=True, eq=False)
class Table:
    """Hold a log's rows, and the causes that may be named by now."""

    time: np.ndarray
    position: np.ndarray
    torque: np.ndarray
    told: frozenset[str] = CAUSELESS

    @classmethod
    def of(cls, rows: LogRows) -> "Table":
        """Copy a log's rows."""
        assert rows.torque is not None
        return cls(rows.time.copy(), rows.position.copy(), rows.torque.copy())

    @property
    def joints(self) -> int:
        """Count the joints."""
        return self.position.shape[1]

    def at(self, rows: np.ndarray | slice) -> "Table":
        """Take some rows, in their order."""
        return replace(self, time=self.time[rows], position=self.position[rows], torque=self.torque[rows])

    def telling(self, *causes: str) -> "Table":
        """Allow these causes to be named."""
        return replace(self, told=self.told | set(causes))

    def csv(self) -> str:
        """Write the table under default names."""
        names = [f"{channel}_{joint + 1}" for channel in ("q", "tau") for joint in range(self.joints)]
        lines = [",".join(["t", *names])]
        cells = np.column_stack([self.time, self.position, self.torque])
        lines += [",".join("" if np.isnan(cell) else f"{cell:.16g}" for cell in row) for row in cells]
        return "\n".join(lines) + "\n"

    def mapping(self) -> dict[str, object]:
        """Declare SI units of the columns."""
        joints = range(1, self.joints + 1)
        return {
            "time": {"column": "t", "unit": "s"},
            "position": {"columns": [f"q_{joint}" for joint in joints], "unit": "rad"},
            "torque": {"columns": [f"tau_{joint}" for joint in joints], "unit": "N m"},
        }


Way = Callable[[Table, np.random.Generator], Table]


def _some_rows(table: Table, rng: np.random.Generator, most: int) -> np.ndarray:
    return rng.choice(len(table.time), int(rng.integers(1, most + 1)), replace=False)


def _run(table: Table, rng: np.random.Generator, seconds: float) -> slice:
    """Draw a stretch of up to so many seconds."""
    rate = (len(table.time) - 1) / (table.time[-1] - table.time[0])
    length = max(1, int(rng.uniform(0.0, seconds) * rate))
    first = int(rng.integers(1, max(2, len(table.time) - length)))
    return slice(first, first + length)


def _joint(table: Table, rng: np.random.Generator) -> int:
    return int(rng.integers(table.joints))


def _some_joints(table: Table, rng: np.random.Generator) -> list[int]:
    return list(range(table.joints)) if rng.random() < 0.3 else [_joint(table, rng)]


def zeros_at_an_end(table: Table, rng: np.random.Generator) -> Table:
    """Write zeros into the first or last rows, as a buffer that was not filled."""
    rows = (
        slice(0, int(rng.integers(1, 200))) if rng.random() < 0.6 else slice(-int(rng.integers(1, 50)), None)
    )
    table.position[rows], table.torque[rows] = 0.0, 0.0
    return table


def held_at_the_start(table: Table, rng: np.random.Generator) -> Table:
    """Repeat the first row, as before the robot answers."""
    rows = slice(0, int(rng.integers(1, 300)))
    table.position[rows], table.torque[rows] = table.position[0], table.torque[0]
    return table.telling("dropped_samples")


def zeros_inside(table: Table, rng: np.random.Generator) -> Table:
    """Write zeros into a few rows, as for a lost packet."""
    for row in _some_rows(table, rng, 5):
        rows = slice(row, row + int(rng.integers(1, 8)))
        table.position[rows], table.torque[rows] = 0.0, 0.0
    return table


def held_inside(table: Table, rng: np.random.Generator) -> Table:
    """Repeat rows, as a recorder does that missed some."""
    for row in _some_rows(table, rng, 20):
        rows = slice(row + 1, row + 1 + int(rng.integers(1, 15)))
        table.position[rows], table.torque[rows] = table.position[row], table.torque[row]
    return table.telling("dropped_samples")


def missing_values(table: Table, rng: np.random.Generator) -> Table:
    """Leave cells empty."""
    rows = _some_rows(table, rng, 30)
    columns = table.position if rng.random() < 0.5 else table.torque
    columns[rows, _joint(table, rng)] = np.nan
    return table


def missing_rows(table: Table, rng: np.random.Generator) -> Table:
    """Leave out rows at random."""
    return table.at(rng.random(len(table.time)) > rng.uniform(0.001, 0.1))


def gap(table: Table, rng: np.random.Generator) -> Table:
    """Leave out a stretch."""
    rows = _run(table, rng, 2.0)
    return table.at(np.r_[0 : rows.start, rows.stop : len(table.time)])


def doubled_rows(table: Table, rng: np.random.Generator) -> Table:
    """Write some rows twice, stamps and all."""
    return table.at(np.sort(np.r_[np.arange(len(table.time)), _some_rows(table, rng, 20)]))


def restarted_time(table: Table, rng: np.random.Generator) -> Table:
    """Begin the time anew."""
    row = int(rng.uniform(0.2, 0.8) * len(table.time))
    table.time[row:] -= table.time[row] - table.time[0]
    return table


def disordered_rows(table: Table, rng: np.random.Generator) -> Table:
    """Exchange stretches of rows, each with its stamps."""
    row = int(rng.uniform(0.2, 0.8) * len(table.time))
    return table.at(np.r_[row : len(table.time), 0:row])


def position_spikes(table: Table, rng: np.random.Generator) -> Table:
    """Let single positions leap by anything from a hundredth of a radian up."""
    rows = _some_rows(table, rng, 20)
    sizes = 10.0 ** rng.uniform(-2.0, 4.0, len(rows)) * rng.choice([-1.0, 1.0], len(rows))
    table.position[rows, _joint(table, rng)] += sizes
    return table


def torque_spikes(table: Table, rng: np.random.Generator) -> Table:
    """Let single torques leap by up to a million times their size."""
    rows, joint = _some_rows(table, rng, 20), _joint(table, rng)
    sizes = 10.0 ** rng.uniform(-0.5, 6.0, len(rows)) * rng.choice([-1.0, 1.0], len(rows))
    table.torque[rows, joint] += sizes * np.nanstd(table.torque[:, joint])
    return table


def stuck_torque(table: Table, rng: np.random.Generator) -> Table:
    """Hold a torque though the joint moves on."""
    rows, joint = _run(table, rng, 1.0), _joint(table, rng)
    table.torque[rows, joint] = table.torque[rows.start - 1, joint]
    return table


def stuck_position(table: Table, rng: np.random.Generator) -> Table:
    """Hold a position though the joint moves on."""
    rows, joint = _run(table, rng, 1.0), _joint(table, rng)
    table.position[rows, joint] = table.position[rows.start - 1, joint]
    return table


def dead_torque(table: Table, rng: np.random.Generator) -> Table:
    """Measure no torque of a joint."""
    table.torque[:, _joint(table, rng)] = 0.0
    return table


def cut_torque(table: Table, rng: np.random.Generator) -> Table:
    """Cut a torque off below its largest value."""
    joint = _joint(table, rng)
    most = rng.uniform(0.7, 0.95) * np.nanmax(np.abs(table.torque[:, joint]))
    table.torque[:, joint] = np.clip(table.torque[:, joint], -most, most)
    return table.telling("torque_saturation")


def coarse_positions(table: Table, rng: np.random.Generator) -> Table:
    """Round the positions to a few digits."""
    step = 10.0 ** rng.uniform(-5.0, -2.5)
    return replace(table, position=step * np.round(table.position / step)).telling("encoder_quantization")


def coarse_torques(table: Table, rng: np.random.Generator) -> Table:
    """Round the torques to some hundredths of their size."""
    step = rng.uniform(0.003, 0.1) * np.maximum(np.nanstd(table.torque, axis=0), 1e-9)
    return replace(table, torque=step * np.round(table.torque / step))


def degrees(table: Table, rng: np.random.Generator) -> Table:
    """Write positions in degrees that were declared in radians."""
    table.position[:, _some_joints(table, rng)] *= 180.0 / np.pi
    return table


def thousandths(table: Table, rng: np.random.Generator) -> Table:
    """Write torques in thousandths of the unit that was declared."""
    table.torque[:, _some_joints(table, rng)] *= 1000.0
    return table


def reversed_torque(table: Table, rng: np.random.Generator) -> Table:
    """Turn the sign of torques."""
    table.torque[:, _some_joints(table, rng)] *= -1.0
    return table


def reversed_position(table: Table, rng: np.random.Generator) -> Table:
    """Turn the sign of a position."""
    table.position[:, _joint(table, rng)] *= -1.0
    return table


def exchanged(table: Table, rng: np.random.Generator) -> Table:
    """Exchange the torques, positions or both of two joints."""
    order = np.arange(table.joints)
    first, second = rng.choice(table.joints, 2, replace=False)
    order[[first, second]] = order[[second, first]]
    channels = str(rng.choice(["position", "torque", "both"]))
    return replace(
        table,
        position=table.position if channels == "torque" else table.position[:, order],
        torque=table.torque if channels == "position" else table.torque[:, order],
    )


def geared(table: Table, rng: np.random.Generator) -> Table:
    """Write a torque on the motor's side of a gear."""
    table.torque[:, _joint(table, rng)] /= rng.choice([50.0, 100.0, 160.0])
    return table


def milliseconds(table: Table, _rng: np.random.Generator) -> Table:
    """Write stamps in milliseconds that were declared in seconds."""
    return replace(table, time=1e3 * table.time)


def a_turn_further(table: Table, rng: np.random.Generator) -> Table:
    """Count a position on by a whole turn from some row on, as a wrapped angle does."""
    table.position[int(rng.uniform(0.2, 0.8) * len(table.time)) :, _joint(table, rng)] += 2.0 * np.pi
    return table


def another_zero(table: Table, rng: np.random.Generator) -> Table:
    """Count a position from another zero."""
    table.position[:, _joint(table, rng)] += rng.choice([-1.0, 1.0]) * rng.choice([0.05, 0.5 * np.pi, np.pi])
    return table.telling("encoder_offset")


def late_torques(table: Table, rng: np.random.Generator) -> Table:
    """Write every torque into a later row."""
    rows = int(rng.integers(1, 6))
    later = np.r_[np.zeros(rows, dtype=int), np.arange(len(table.time) - rows)]
    return replace(table, torque=table.torque[later]).telling("time_delay", "torque_filter_lag")


def scattered_stamps(table: Table, rng: np.random.Generator) -> Table:
    """Let stamps scatter about the instants of their rows."""
    step = np.median(np.abs(np.diff(table.time)))
    scatter = rng.uniform(0.01, 0.3) * step * rng.uniform(-1.0, 1.0, len(table.time))
    # A row that was written twice is one that was missed, once its stamp differs.
    doubled = ("dropped_samples",) if np.any(np.diff(table.time) == 0.0) else ()
    return replace(table, time=table.time + scatter).telling("timestamp_jitter", *doubled)


def rounded_stamps(table: Table, rng: np.random.Generator) -> Table:
    """Round stamps to a thousandth or a hundredth of a second."""
    return replace(table, time=np.round(table.time, int(rng.choice([2, 3])))).telling("timestamp_jitter")


def since_1970(table: Table, rng: np.random.Generator) -> Table:
    """Count seconds from 1970, at times from some row on only."""
    first = 0 if rng.random() < 0.5 else int(rng.integers(1, 50))
    table.time[first:] += 1.8e9
    return table


WAYS: dict[str, Way] = {
    way.__name__: way
    for way in (
        zeros_at_an_end, held_at_the_start, zeros_inside, held_inside, missing_values, missing_rows, gap,
        doubled_rows, restarted_time, disordered_rows, position_spikes, torque_spikes, stuck_torque,
        stuck_position, dead_torque, cut_torque, coarse_positions, coarse_torques, degrees, thousandths,
        reversed_torque, reversed_position, exchanged, geared, milliseconds, a_turn_further, another_zero,
        late_torques, scattered_stamps, rounded_stamps, since_1970,
    )
}  # fmt: skip  # a table
