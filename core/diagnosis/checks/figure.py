"""Prepare a finding's figure: one joint's residual over the coordinate that explains it, before and after.

Friction's sign follows the direction of motion, so that over a load or an angle its effects of both
directions cancel. Where the coordinate alone does not determine the torque, each direction has its curve.
"""

from collections.abc import Callable

import numpy as np

from ...arrays import Indices, JointSeries, Vector, Weights
from ...dynamics.prediction import Prediction
from ..causes.protocol import Site
from ..dataset.dataset import Dataset
from ..regression.rows import Columns
from ..residual.coordinates import coordinate
from ..result import Curve
from ..search.hypothesis import Hypothesis

BINS = 36
EXPLAINED = 0.8
"""Share of a finding's torque below which the coordinate alone does not determine it, only with direction."""
STAND_IN = {"load_jerk": "torque_rate", "load_rate": "torque_rate"}


def curve(
    dataset: Dataset,
    operating_point: Prediction,
    chosen: Hypothesis,
    index: int,
    columns: Columns,
    left: tuple[JointSeries, JointSeries],
) -> Curve | None:
    """Bin the residual without and with a finding over its coordinate, on the joint that it acts on most.

    Parameters
    ----------
    left
        Residual without and with the finding, rows x joints.
    """
    member = chosen.members[index]
    torque = {joint: part @ chosen.fit.values[chosen.columns_of(index)] for joint, part in columns.items()}
    joint = max(torque, key=lambda joint: _share(torque[joint], left[0][:, joint], dataset.usable[:, joint]))
    name = STAND_IN.get(member.cause.coordinate, member.cause.coordinate)
    if name == "other_velocity":
        name = _other_velocity(joint, member.site)
    along = coordinate(dataset, operating_point, name, joint + 1) or coordinate(
        dataset, operating_point, "time", joint + 1
    )
    if along is None:
        return None
    rows = np.flatnonzero(dataset.clear[:, joint])
    own, forward = torque[joint][rows], dataset.state.velocity[rows, joint] > 0.0
    together, apart = _bins(rows, along.values), _bins_by_direction(rows, forward, along.values)
    share, share_apart = _explained_by_means(own, rows, together), _explained_by_means(own, rows, apart)
    split = share < EXPLAINED and share_apart > share
    groups = apart if split else together
    return Curve(
        coordinate=along.name,
        unit=along.unit,
        joint=joint + 1,
        centre=_bin_values(groups, along.values, np.median),
        before=_bin_values(groups, left[0][:, joint], np.mean),
        after=_bin_values(groups, left[1][:, joint], np.mean),
        model=_bin_values(groups, torque[joint], np.mean),
        standard_error=_bin_values(groups, left[1][:, joint], np.std) / np.sqrt(list(map(len, groups))),
        direction=_bin_values(groups, np.sign(dataset.state.velocity[:, joint]), np.median)
        if split
        else np.zeros(len(groups)),
    )


def _other_velocity(joint: int, site: Site) -> str:
    """Name the velocity of the other joint of a pair."""
    others = [other for other in site if other != joint + 1]
    return f"velocity_of_joint_{others[0]}" if others else "velocity"


def _bins(rows: Indices, along: Vector, bins: int = BINS) -> list[Indices]:
    """Sort rows along a coordinate into groups of equal size."""
    order = rows[np.argsort(along[rows], kind="stable")]
    return [group for group in np.array_split(order, bins) if len(group) >= 2]


def _bins_by_direction(rows: Indices, forward: np.ndarray, along: Vector) -> list[Indices]:
    """Do the same for backward and for forward motion, one after the other."""
    return [
        group for part in (rows[~forward], rows[forward]) for group in _bins(part, along, max(BINS // 2, 1))
    ]


def _explained_by_means(torque: Vector, rows: Indices, groups: list[Indices]) -> float:
    """Give the share of a torque's variance over some rows that the means of groups explain."""
    total = float(np.var(torque)) * len(rows)
    order = np.empty(int(rows.max(initial=0)) + 1, dtype=int)
    order[rows] = np.arange(len(rows))
    within = sum(float(np.var(torque[order[group]])) * len(group) for group in groups)
    return 1.0 - within / max(total, 1e-300)


def _bin_values(groups: list[Indices], values: Vector, measure: Callable[[Weights], np.floating]) -> Weights:
    return np.array([float(measure(values[group])) for group in groups])


def _share(torque: np.ndarray, residual: np.ndarray, usable: np.ndarray) -> float:
    return float(np.sum(torque[usable] ** 2) / max(float(np.sum(residual[usable] ** 2)), 1e-300))
