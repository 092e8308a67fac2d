"""Name the coordinates of a motion that a residual can depend on, and give them at a data set's rows.

An effect that a simulation misses depends on angle (ripple, springs), speed (friction), transmitted load
(gears), distance since reversal (presliding), time or temperature (drift). All coordinates come from the
motion and from the *predicted* torque, never from the measured one, whose noise is in the residual too.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ...arrays import JointSeries, Samples
from ...dynamics.prediction import Prediction
from ...errors import OptionError
from ...robot.joint_units import joint_unit
from ..dataset.dataset import Dataset

OTHER_VELOCITY = "velocity_of_joint_"


@dataclass(frozen=True, eq=False)
class Coordinate:
    """Hold one coordinate at every row of a data set."""

    name: str
    joint: int
    """The joint whose residual is shown, counted from 1."""
    unit: str
    """Unit of the values; ``m`` stands for ``rad`` where the joint that moves slides."""
    values: Samples


@dataclass(frozen=True)
class _Kind:
    unit: str
    series: Callable[[Dataset, Prediction], JointSeries | None]


def coordinate_names(dataset: Dataset) -> tuple[str, ...]:
    """List the names of all coordinates that a joint of this data set may have."""
    others = tuple(f"{OTHER_VELOCITY}{number}" for number in range(1, dataset.joints + 1))
    return (*_KINDS, *others)


def coordinate(dataset: Dataset, operating_point: Prediction, name: str, joint: int) -> Coordinate | None:
    """Give one coordinate of one joint; None where the robot or the log does not have it.

    Parameters
    ----------
    name
        One of `coordinate_names`; ``velocity_of_joint_k`` is the velocity of another joint.
    joint
        Counted from 1.

    Raises
    ------
    OptionError
        If there is no such coordinate or joint.
    """
    if name not in coordinate_names(dataset) or not 1 <= joint <= dataset.joints:
        raise OptionError(
            "there is no such coordinate",
            evidence={"name": name, "joint": joint, "joints": dataset.joints},
            remedy="ask for one of " + ", ".join(coordinate_names(dataset)) + " of a joint counted from 1",
        )
    series = coordinate_series(dataset, operating_point, name)
    if name.startswith(OTHER_VELOCITY):
        return _other(dataset, name, joint, series)
    if series is None or np.isnan(series[:, joint - 1]).all():
        return None
    return Coordinate(name, joint, _unit(dataset, name, joint), series[:, joint - 1])


def coordinate_series(dataset: Dataset, operating_point: Prediction, name: str) -> JointSeries | None:
    """Give one coordinate for all joints at once: rows x joints, NaN for joints that lack it."""
    kind = "velocity" if name.startswith(OTHER_VELOCITY) else name
    return _KINDS[kind].series(dataset, operating_point)


def travel(position: Samples, velocity: Samples) -> Samples:
    """Give the distance since the last reversal, rad or m; from the first row on where there was none yet.

    Examples
    --------
    >>> travel(np.array([0.0, 1.0, 2.0, 1.5, 0.5]), np.array([1.0, 1.0, 1.0, -1.0, -1.0]))
    array([0. , 1. , 2. , 0.5, 1.5])
    """
    gone = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(position)))])
    turns = np.flatnonzero(velocity[1:] * velocity[:-1] < 0.0)
    begins = np.zeros(len(position))
    begins[turns + 1] = gone[turns]
    return np.asarray(gone - np.maximum.accumulate(begins))


def _unit(dataset: Dataset, name: str, joint: int) -> str:
    """Give a coordinate's unit; a motor turns whatever its joint does."""
    unit = _KINDS[name].unit
    return unit if name == "motor_phase" else joint_unit(dataset.robot, joint, unit)


def _other(dataset: Dataset, name: str, joint: int, velocity: JointSeries | None) -> Coordinate | None:
    moving = int(name.removeprefix(OTHER_VELOCITY))
    if moving == joint or velocity is None:
        return None
    return Coordinate(name, joint, joint_unit(dataset.robot, moving, "rad/s"), velocity[:, moving - 1])


def _time(dataset: Dataset, operating_point: Prediction) -> JointSeries:
    del operating_point
    return np.repeat(dataset.time[:, None], dataset.joints, axis=1)


def _torque_rate(dataset: Dataset, operating_point: Prediction) -> JointSeries:
    torque, out = operating_point.load(dataset.state), np.zeros_like(dataset.torque)
    for stretch in dataset.stretches:
        rows = stretch.rows
        if rows.stop - rows.start > 1:
            out[rows] = np.gradient(torque[rows], dataset.time[rows], axis=0)
    return out


def _travel(dataset: Dataset, operating_point: Prediction) -> JointSeries:
    del operating_point
    out = np.zeros_like(dataset.torque)
    for stretch in dataset.stretches:
        for joint in range(dataset.joints):
            position, velocity = dataset.state.position[stretch.rows, joint], dataset.state.velocity
            out[stretch.rows, joint] = travel(position, velocity[stretch.rows, joint])
    return out


def _motor_phase(dataset: Dataset, operating_point: Prediction) -> JointSeries | None:
    del operating_point
    ratios = np.array([joint.gear_ratio or np.nan for joint in dataset.robot.joints])
    if np.isnan(ratios).all():
        return None
    return np.asarray(np.mod(dataset.state.position * ratios, 2.0 * np.pi))


_KINDS: Mapping[str, _Kind] = {
    "time": _Kind("s", _time),
    "position": _Kind("rad", lambda dataset, _: dataset.state.position),
    "velocity": _Kind("rad/s", lambda dataset, _: dataset.state.velocity),
    "acceleration": _Kind("rad/s2", lambda dataset, _: dataset.state.acceleration),
    "load": _Kind("N m", lambda dataset, operating_point: operating_point.load(dataset.state)),
    "torque": _Kind("N m", lambda dataset, operating_point: operating_point.torque(dataset.state)),
    "torque_rate": _Kind("N m/s", _torque_rate),
    "travel": _Kind("rad", _travel),
    "motor_phase": _Kind("rad", _motor_phase),
    "temperature": _Kind("degC", lambda dataset, _: dataset.state.temperature),
}
