"""Find pushes on an arm that stands: torque that comes and goes, and is more than friction holds.

While all joints stand, gravity is constant and friction holds any torque up to its level. So torque may
change by twice that level without anything happening. What changes by more, and returns before the arm moves
again, came from outside. A brake that engages or a controller that relaxes does not return; one that opens
does so where the arm begins to move.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Indices, Jacobian, JointSeries, JointVector, SampleMask
from ...dynamics.prediction import Prediction
from ...dynamics.terms.coulomb import Coulomb
from ...dynamics.terms.external_contact import contact_jacobian
from ...numerics.distributions import normal_tail
from ...robot.joint_units import joint_unit
from ..causes.protocol import Quantity, number_text
from ..causes.sample_check import SampleFinding
from ..causes.shared.own_joint import end_links
from ..dataset.dataset import Dataset
from ..regression.innovation_covariance import torque_residual
from ..thresholds.checks import AT_REST


@dataclass(frozen=True, eq=False)
class _Scale:
    """Hold, per joint, the residual's RMS in motion, and by how much torque may change at rest."""

    noise: JointVector
    limits: JointVector


@dataclass(frozen=True)
class _Push:
    """Hold one push: its log, when it acts (s), the force (N) that would do it, and where torque shows it."""

    log: str
    begin: float
    end: float
    step: float
    force: float
    deviation: float
    joint: int
    torque: float
    limit: float
    excess: float
    """The joint, from 1, whose torque shows it best: by how much it changes, by how much it may, and the
    difference in standard deviations."""


def contacts_at_rest(dataset: Dataset, operating_point: Prediction) -> tuple[SampleFinding, ...]:
    """Give all pushes on the last link of an arm as one finding; none where it has several ends."""
    links = end_links(dataset.robot)
    if len(links) != 1:
        return ()
    ((joint, link),) = links.items()
    scale, jacobian = _scale(dataset, operating_point), contact_jacobian(dataset.robot, link, dataset.state)
    pushes = []
    for rows in _stands(dataset):
        edge = max(AT_REST.edge_rows, int(AT_REST.edge_share * len(rows)))
        torque = dataset.torque[rows]
        ends = np.array([np.median(part, axis=0) for part in (torque[:edge], torque[-edge:])])
        change = torque - ends.mean(axis=0)
        returns = (np.abs(ends[1] - ends[0]) < scale.limits).all()
        if returns and _lies_between((np.abs(change) > scale.limits).any(axis=1)):
            pushes.append(_push(dataset, rows, change, jacobian[rows], scale))
    return (_finding(dataset, joint, pushes),) if pushes else ()


def _lies_between(beyond: SampleMask) -> bool:
    """Tell whether there are such rows, and none near either end of a stand."""
    near = AT_REST.edge_rows
    return bool(beyond[near:-near].any() and not (beyond[:near].any() or beyond[-near:].any()))


def _scale(dataset: Dataset, operating_point: Prediction) -> _Scale:
    """Tell how far torque may change at rest; any way on a joint that never moves."""
    left, count = torque_residual(dataset, operating_point), dataset.clear.sum(axis=0)
    squares = np.sum(left**2, axis=0, where=dataset.clear)
    noise = np.sqrt(np.divide(squares, count, out=np.full(len(count), np.inf), where=count > 0))
    return _Scale(noise, 2.0 * _coulomb_levels(operating_point) + AT_REST.deviations * noise)


def _coulomb_levels(operating_point: Prediction) -> JointVector:
    """Give every joint's Coulomb friction, N m or N; nothing where the model has none."""
    levels = np.zeros(len(operating_point.model.robot.joints))
    for parameter, value in zip(operating_point.model.parameters, operating_point.standard, strict=True):
        if parameter.symbol == Coulomb.symbol[0]:
            levels[parameter.number - 1] += abs(value)
    return levels


def _stands(dataset: Dataset) -> Iterator[Indices]:
    """Give the rows of every time in which all joints stand, without those in which the filter settles."""
    held = np.max([motion.recipe.still_speed for motion in dataset.motions], axis=0)
    slow = np.maximum(AT_REST.still_share * dataset.speed, held)
    rows = np.flatnonzero((np.abs(dataset.state.velocity) <= slow).all(axis=1))
    for run in np.split(rows, np.flatnonzero(~dataset.follows(rows))):
        inner = run[AT_REST.settling_rows : len(run) - AT_REST.settling_rows]
        ends = 2 * AT_REST.edge_rows
        if len(inner) >= 2 * ends and _stays(dataset, inner):
            yield inner


def _stays(dataset: Dataset, rows: Indices) -> bool:
    """Tell whether positions stay where they are, against how far they come in as many rows elsewhere.

    Where stamps scatter, speeds are mostly noise, and slow motion would pass for a stand.
    """
    position, count = dataset.state.position, len(rows) - 1
    travel = np.ptp(position[rows], axis=0)
    moved = (position[count:] - position[:-count])[dataset.time[count:] > dataset.time[:-count]]
    usual = np.sqrt(np.mean(moved**2, axis=0))
    parked = np.all([motion.recipe.held for motion in dataset.motions], axis=0)
    return bool((parked | (travel <= AT_REST.travel_share * usual)).all())


def _push(dataset: Dataset, rows: Indices, change: JointSeries, jacobian: Jacobian, scale: _Scale) -> _Push:
    time, acts = dataset.time[rows], (np.abs(change) > AT_REST.deviations * scale.noise).any(axis=1)
    relative = np.abs(change) / scale.limits
    peak, best = np.unravel_index(int(np.argmax(relative)), relative.shape)
    weighted = (jacobian[peak][:3] / scale.noise).T
    force, _, rank, sizes = np.linalg.lstsq(weighted, change[peak] / scale.noise)
    torque, limit = float(np.abs(change[peak, best])), float(scale.limits[best])
    return _Push(
        log=dataset.motions[dataset.log[rows[0]]].log.name,
        begin=float(time[acts][0]),
        end=float(time[acts][-1]),
        step=float(np.median(np.diff(time))),
        force=float(np.linalg.norm(force)),
        deviation=float(np.linalg.norm(1.0 / sizes[:rank])),
        joint=int(best) + 1,
        torque=torque,
        limit=limit,
        excess=(torque - limit) / float(scale.noise[best]),
    )


def _finding(dataset: Dataset, joint: int, pushes: Sequence[_Push]) -> SampleFinding:
    """Describe all pushes, by the names that a contact in motion has, and first the largest force."""
    largest = max(pushes, key=lambda push: push.force)
    found = [Quantity("force", joint, "N", largest.force, largest.deviation)]
    for number, push in enumerate(pushes, start=1):
        found += [
            Quantity(f"force_{number}", joint, "N", push.force, push.deviation),
            Quantity(f"start_{number}", None, "s", push.begin, push.step),
            Quantity(f"end_{number}", None, "s", push.end, push.step),
        ]
    clearest = max(push.excess for push in pushes)
    described = "; ".join(_described(dataset, push) for push in pushes)
    return SampleFinding(
        site=(joint,),
        quantities=tuple(found),
        statement=f"External contact while the arm stands: {described}",
        statistic=clearest,
        p_value=max(2.0 * normal_tail(AT_REST.deviations + clearest), 1e-300),
        residual_share=np.zeros(dataset.joints),
    )


def _described(dataset: Dataset, push: _Push) -> str:
    unit = joint_unit(dataset.robot, push.joint, "N m")
    where = f" of {push.log}" if len(dataset.motions) > 1 else ""
    return (
        f"from {push.begin:.3g} s to {push.end:.3g} s{where} the torque of joint {push.joint} changes by "
        f"{number_text(push.torque, 3)} {unit} and returns, where friction and noise explain "
        f"{number_text(push.limit, 3)} {unit}"
    )
