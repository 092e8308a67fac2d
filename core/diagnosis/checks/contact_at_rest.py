"""Find pushes on an arm that stands: torque that comes and goes, and is more than friction holds.

While all joints stand, gravity is constant and friction holds any torque up to its level. So torque may
change by twice that level without anything happening. What changes by more, and returns before the arm moves
again, came from outside. A brake that engages or a controller that relaxes does not return.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.stats import norm

from ...arrays import Indices, JointSeries, JointVector, Vector
from ...dynamics.jacobian import Jacobian
from ...dynamics.prediction import Prediction
from ...dynamics.terms.coulomb import Coulomb
from ...dynamics.terms.external_contact import contact_jacobian
from ...robot.joint_units import joint_unit
from ..causes.protocol import Quantity, number_text
from ..causes.sample_check import SampleFinding
from ..causes.shared.own_joint import end_links
from ..dataset.dataset import Dataset
from ..regression.innovation_covariance import torque_residual
from ..thresholds.checks import AT_REST


@dataclass(frozen=True, eq=False)
class Scale:
    """Hold, per joint, the residual's RMS in motion, by how much torque may change at rest, and the unit."""

    noise: JointVector
    limits: JointVector
    units: tuple[str, ...]


def contacts_at_rest(dataset: Dataset, operating_point: Prediction) -> tuple[SampleFinding, ...]:
    """Give the push in every stand that holds one, at the end of the arm's only chain."""
    links = end_links(dataset.robot)
    if len(links) != 1:
        return ()
    ((joint, link),) = links.items()
    left = torque_residual(dataset, operating_point)
    rows = dataset.clear.sum(axis=0)
    squares = np.sum(left**2, axis=0, where=dataset.clear)
    noise = np.sqrt(np.divide(squares, rows, out=np.full(len(rows), np.inf), where=rows > 0))
    limits = 2.0 * _coulomb_levels(operating_point) + AT_REST.deviations * noise
    units = tuple(joint_unit(dataset.robot, number + 1, "N m") for number in range(dataset.joints))
    scale = Scale(noise, limits, units)
    jacobian = contact_jacobian(dataset.robot, link, dataset.state)
    found = []
    for rows in _stands(dataset):
        edge = max(AT_REST.edge_rows, len(rows) // 10)
        torque = dataset.torque[rows]
        ends = np.array([np.median(part, axis=0) for part in (torque[:edge], torque[-edge:])])
        change = torque - ends.mean(axis=0)
        beyond = (np.abs(change) > limits).any(axis=1)
        if beyond.any() and (np.abs(ends[1] - ends[0]) < limits).all():
            found.append(_finding(joint, dataset.time[rows], change, jacobian[rows], scale))
    return tuple(found)


def _coulomb_levels(operating_point: Prediction) -> JointVector:
    """Give every joint's Coulomb friction, N m or N; nothing where the model has none."""
    levels = np.zeros(len(operating_point.model.robot.joints))
    for parameter, value in zip(operating_point.model.parameters, operating_point.standard, strict=True):
        if parameter.symbol == Coulomb.symbol[0]:
            levels[parameter.number - 1] += abs(value)
    return levels


def _stands(dataset: Dataset) -> Iterator[Indices]:
    """Give the rows of every time in which all joints stand, without those in which the filter settles."""
    still = (np.abs(dataset.state.velocity) < AT_REST.still_share * dataset.speed).all(axis=1)
    rows = np.flatnonzero(still)
    if not len(rows):
        return
    for run in np.split(rows, np.flatnonzero(~dataset.follows(rows)[1:]) + 1):
        inner = run[AT_REST.settling_rows : len(run) - AT_REST.settling_rows]
        if len(inner) >= AT_REST.least_rows:
            yield inner


def _finding(joint: int, time: Vector, change: JointSeries, push: Jacobian, scale: Scale) -> SampleFinding:
    """Describe a push by its time and by the force at the last link that would do it."""
    acts = (np.abs(change) > AT_REST.deviations * scale.noise).any(axis=1)
    begin, end = float(time[acts][0]), float(time[acts][-1])
    relative = np.abs(change) / scale.limits
    peak, largest = np.unravel_index(int(np.argmax(relative)), relative.shape)
    weighted = (push[peak][:3] / scale.noise).T
    force, _, rank, sizes = np.linalg.lstsq(weighted, change[peak] / scale.noise)
    doubt = float(np.linalg.norm(1.0 / sizes[:rank])) if rank else 0.0
    step, torque = float(np.median(np.diff(time))), float(np.abs(change[peak, largest]))
    excess = (torque - float(scale.limits[largest])) / float(scale.noise[largest])
    return SampleFinding(
        site=(joint,),
        quantities=(
            Quantity("force", joint, "N", float(np.linalg.norm(force)), doubt),
            Quantity("start_1", None, "s", begin, step),
            Quantity("end_1", None, "s", end, step),
        ),
        statement=(
            f"External contact while the arm stands, from {begin:.3g} s to {end:.3g} s: the torque of joint "
            f"{largest + 1} changes by {number_text(torque, 3)} and returns, where friction can hold "
            f"{number_text(float(scale.limits[largest]), 3)} {scale.units[largest]}"
        ),
        statistic=excess,
        p_value=float(max(2.0 * norm.sf(AT_REST.deviations + excess), 1e-300)),
        residual_share=np.zeros(len(scale.noise)),
    )
