"""Read a robot's log into a `JointLog`: format by content, units converted at once, defects listed.

This is where reading starts. Formats know columns, the layout knows joints and units, and one pass over
the samples refuses what cannot be used and lists what is wrong but usable.
"""

import hashlib
import json
from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..errors import LogError
from .channels import CHANNELS, EFFORTS, JOINT_CHANNELS, TIME
from .columns.binding import Binding
from .columns.layout import Layout, bind
from .columns.mapping import by_name, parse_mapping
from .columns.profiles import fill_in
from .columns.suggestion import explained, suggest_mappings
from .defects.examine import examine
from .formats.combine import combine_stamps, split_lists
from .formats.content import BAG, DELIMITED, MATLAB5, MATLAB7, MCAP, NPZ, PARQUET, SQLITE_BAG, Form, recognise
from .formats.delimited import open_delimited
from .formats.first_rows import first_rows
from .formats.joint_names import name_joints
from .formats.long import widen
from .formats.matlab5 import open_matlab5
from .formats.matlab7 import open_matlab7
from .formats.npz import open_npz
from .formats.parquet import ParquetSource, ParquetTable, open_parquet
from .formats.recording import open_bag, open_mcap, open_sqlite_bag
from .formats.table import Table
from .model import ArraySource, Defect, JointLog, LogRows, LogSource, joined_rows
from .pieces.choose import choose_rows
from .pieces.even_clock import with_even_clock
from .pieces.missing import scarce_channels, scarce_defect
from .pieces.survey import Survey, survey
from .pieces.turns import UnwrappedSource, wrapped_defects

OPENERS: dict[Form, Callable[[Path], Table]] = {
    DELIMITED: open_delimited,
    PARQUET: open_parquet,
    NPZ: open_npz,
    MATLAB5: open_matlab5,
    MATLAB7: open_matlab7,
    MCAP: open_mcap,
    SQLITE_BAG: open_sqlite_bag,
    BAG: open_bag,
}


def read_log(
    path: Path | str,
    *,
    media_type: str | None = None,
    mapping: Mapping[str, object] | None = None,
    name: str | None = None,
    sha256: str = "",
    prismatic: Collection[int] | None = None,
) -> JointLog:
    """Read a log and find its defects.

    Parameters
    ----------
    path
        The file: CSV, Parquet, NPZ, MATLAB v5 or v7.3, MCAP or ROS bag (1 or 2); its bytes decide which.
    media_type
        The declared content type, checked against the bytes.
    mapping
        Channel and unit of each column; see `core.log.columns.mapping`. Default names need none.
    name
        The log's name; the file's stem if None.
    sha256
        Hash of the file's bytes if it is known already; computed if empty.
    prismatic
        Joints of the robot, from 1, that are prismatic, for the mapping that a refusal suggests; None where
        the robot is not known.

    Returns
    -------
    JointLog
        Parquet stays on disk and is read by rows; other formats are held in memory.

    Raises
    ------
    LogError
        If the file cannot be read, a column is missing or of unknown unit, or the samples cannot be used.
    """
    path = Path(path)
    table = open_table(path, media_type)[1]
    seen = first_rows(table)
    try:
        layout = bind_columns(seen, mapping)
    except LogError as error:
        raise error if mapping else _with_suggestion(error, seen, prismatic) from error
    return read_table(table, layout, name=name or path.stem, sha256=sha256 or _hash(path))


def _with_suggestion(error: LogError, table: Table, prismatic: Collection[int] | None) -> LogError:
    """Add the mapping that names and values of the columns suggest, to be confirmed.

    Where the robot is not known, the same with prismatic joints alone stands beside it.
    """
    mappings = suggest_mappings(table, prismatic or ())
    if not mappings:
        return explained(error, table)
    evidence = error.evidence | {"suggested_mappings": mappings}
    if prismatic is None:
        every = range(1, len(table.names) + 1)
        evidence |= {"suggested_if_prismatic": suggest_mappings(table, every)}
    several = ", one for each arm" if len(mappings) > 1 else ""
    written = " or ".join(json.dumps(mapping, ensure_ascii=False) for mapping in mappings)
    return LogError(
        error.cause,
        evidence=evidence,
        remedy=f"{error.remedy}; or check the mapping that the columns suggest{several}: {written}",
    )


def open_table(path: Path, media_type: str | None = None) -> tuple[Form, Table]:
    """Recognise a file and open it as named columns, of which none is read yet.

    Raises
    ------
    LogError
        If the file is of no format that holds a log, or damaged.
    """
    form = recognise(path, media_type)
    return form, widen(combine_stamps(split_lists(name_joints(OPENERS[form](path)))))


def bind_columns(table: Table, mapping: Mapping[str, object] | None) -> Layout:
    """Bind columns to channels and joints.

    Raises
    ------
    LogError
        If a column is missing or of unknown unit, or the mapping is not understood.
    """
    return bind(table, parse_mapping(by_name(fill_in(mapping, table.names), table.names)))


def read_table(table: Table, layout: Layout, *, name: str, sha256: str) -> JointLog:
    """Read the samples and find their defects.

    No computation uses reference channels, so that a log is read without those that cannot be used.

    Raises
    ------
    LogError
        If the samples cannot be used.
    """

    def log_of(layout: Layout) -> JointLog:
        return _log_of(name, lambda chosen: _source_of(table, chosen), layout, sha256)

    try:
        log = log_of(layout)
    except LogError:
        if not layout.default_references:
            raise
        log = log_of(layout.without(layout.default_references))
    return replace(log, defects=(*_rearranged(table, log.samples), *log.defects))


def log_from_arrays(
    name: str, time: np.ndarray, position: np.ndarray, torque: np.ndarray | None, **channels: np.ndarray
) -> JointLog:
    """Make a log of arrays in SI, under the same checks as a file.

    Parameters
    ----------
    time
        Stamps in s.
    position
        In rad or m; one column per joint.
    torque
        In N m or N; None if a current is given.
    **channels
        By the names of `CHANNELS`: `velocity` per s, `current` in A, `temperature` in degC ...

    Raises
    ------
    LogError
        If the shapes disagree, a channel is not known, or the samples cannot be used.

    Examples
    --------
    >>> time = np.arange(500) / 250.0
    >>> swing = np.sin(np.outer(time, [3.0, 4.0]))
    >>> round(log_from_arrays("swing", time, swing, 5.0 * swing).rate_hz, 6)
    250.0
    """
    _refuse_unknown(channels)
    arrays = {
        key: np.array(value, dtype=np.float64, order="C", ndmin=2)
        for key, value in {"position": position, "torque": torque, **channels}.items()
        if value is not None
    }
    clock = np.array(time, dtype=np.float64)
    _check_shapes(clock, arrays)
    joints = range(1, arrays["position"].shape[1] + 1)
    plain = tuple(1.0 for _ in joints), tuple(0.0 for _ in joints)
    layout = Layout(
        time=Binding(TIME, (TIME,), (1.0,), (0.0,)),
        rate_hz=0.0,
        channels=tuple(
            Binding(key, tuple(f"{CHANNELS[key].prefix}_{j}" for j in joints), *plain) for key in arrays
        ),
    )

    def source_of(chosen: Layout) -> LogSource:
        return ArraySource(LogRows(clock, **{bound.name: arrays[bound.name] for bound in chosen.channels}))

    return _log_of(name, source_of, layout, "")


def _refuse_unknown(channels: Collection[str]) -> None:
    known = [channel.name for channel in JOINT_CHANNELS]
    unknown = sorted(set(channels) - set(known))
    if unknown:
        raise LogError(
            f"there is no channel {unknown[0]!r}", evidence={"known": known}, remedy="name a known channel"
        )


def _check_shapes(clock: np.ndarray, arrays: dict[str, np.ndarray]) -> None:
    shapes = {"time": clock.shape, **{key: array.shape for key, array in arrays.items()}}
    wanted = (len(clock), arrays["position"].shape[1])
    if clock.ndim != 1 or any(array.shape != wanted for array in arrays.values()):
        raise LogError(
            "the channels disagree in shape", evidence=shapes, remedy="give every channel samples by joints"
        )
    if not set(EFFORTS) & set(arrays):
        raise LogError(
            "the log has neither torque nor current", evidence=shapes, remedy="give one of the two"
        )


def _source_of(table: Table, layout: Layout) -> LogSource:
    """Open the samples of all rows."""
    if isinstance(table, ParquetTable):
        return ParquetSource(table, layout)
    parts, samples = [layout.convert(np.empty((len(layout.columns), 0)), 0)], 0
    for block in table.batches(layout.columns):
        parts.append(layout.convert(block, samples))
        samples += block.shape[1]
    return ArraySource(joined_rows(parts))


def _rearranged(table: Table, samples: int) -> tuple[Defect, ...]:
    """State what was done to get columns out of the file."""
    if not table.notes:
        return ()
    statement = f"The file is no plain table, and was read so: {'; '.join(table.notes)}."
    return (Defect("rearranged", "file", None, samples, (), statement),)


def _log_of(name: str, source_of: Callable[[Layout], LogSource], layout: Layout, sha256: str) -> JointLog:
    whole, found, wrapped = _followed(source_of(layout), layout)
    scarce = scarce_channels(found, layout)
    left_out = tuple(scarce_defect(found, layout, channel) for channel in scarce)
    if scarce:
        layout = layout.without(scarce)
        whole, found, wrapped = _followed(source_of(layout), layout)
    chosen = choose_rows(whole, layout, found)
    source = chosen.source
    source, rounded = with_even_clock(source) if found.shared else (source, [])
    seen = examine(source, layout, chosen.row_in_file)
    return JointLog(
        name=name,
        source=source,
        joints=layout.joints,
        rate_hz=seen.rate_hz,
        duration=seen.duration,
        segments=seen.segments,
        defects=(*left_out, *wrapped, *chosen.done, *rounded, *seen.defects),
        channels=tuple(channel.name for channel in layout.channels),
        ignored_columns=layout.ignored,
        sha256=sha256,
        bindings=layout.bindings,
    )


def _followed(source: LogSource, layout: Layout) -> tuple[LogSource, Survey, list[Defect]]:
    """Pass over the rows, and once more where angles are wrapped, without the turns."""
    units = layout.si_units()["position"]
    found = survey(source, units)
    wrapped = found.turns.found
    if not wrapped:
        return source, found, []
    followed = UnwrappedSource(source, wrapped)
    return followed, survey(followed, units), wrapped_defects(wrapped)


def _hash(path: Path) -> str:
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
