"""Show a finding: one joint's residual over the coordinate that explains it, before and after."""

import numpy as np

from core.arrays import JointSeries
from core.diagnosis.cause import Site
from core.diagnosis.diagnosis import Curve
from core.diagnosis.equations import Columns
from core.diagnosis.hypothesis import Hypothesis
from core.diagnosis.look import Look
from core.diagnosis.residual.coordinates import coordinate
from core.dynamics.prediction import Prediction

BINS = 36
STAND_IN = {"load_jerk": "torque_rate", "load_rate": "torque_rate"}


def curve(
    look: Look,
    believed: Prediction,
    chosen: Hypothesis,
    place: int,
    columns: Columns,
    left: tuple[JointSeries, JointSeries],
) -> Curve | None:
    """Bin the residual without and with a finding over its coordinate, on the joint that it acts on most.

    Parameters
    ----------
    left
        Residual without and with the finding, rows x joints.
    """
    member = chosen.members[place]
    torque = {joint: part @ chosen.fit.values[chosen.columns_of(place)] for joint, part in columns.items()}
    joint = max(torque, key=lambda one: _share(torque[one], left[0][:, one], look.usable[:, one]))
    name = STAND_IN.get(member.cause.coordinate, member.cause.coordinate)
    if name == "other_velocity":
        name = _of_other(joint, member.site)
    along = coordinate(look, believed, name, joint + 1) or coordinate(look, believed, "time", joint + 1)
    if along is None:
        return None
    rows = np.flatnonzero(look.clear[:, joint])
    order = rows[np.argsort(along.values[rows], kind="stable")]
    groups = [group for group in np.array_split(order, BINS) if len(group) >= 2]
    return Curve(
        coordinate=along.name,
        unit=along.unit,
        joint=joint + 1,
        centre=np.array([float(np.median(along.values[group])) for group in groups]),
        before=np.array([float(np.mean(left[0][group, joint])) for group in groups]),
        after=np.array([float(np.mean(left[1][group, joint])) for group in groups]),
        model=np.array([float(np.mean(torque[joint][group])) for group in groups]),
        standard_error=np.array(
            [float(np.std(left[1][group, joint]) / np.sqrt(len(group))) for group in groups]
        ),
    )


def _of_other(joint: int, site: Site) -> str:
    """Name the velocity of the other joint of a pair."""
    others = [one for one in site if one != joint + 1]
    return f"velocity_of_joint_{others[0]}" if others else "velocity"


def _share(torque: np.ndarray, residual: np.ndarray, usable: np.ndarray) -> float:
    return float(np.sum(torque[usable] ** 2) / max(float(np.sum(residual[usable] ** 2)), 1e-300))
