"""Tell whether the size of a cause makes sense beside the log, whatever the likelihood says.

A cause whose torque exceeds all the torque of its joint is cancelled by another column: it stands for a
direction that the motion leaves open. A cause none of whose sizes exceeds its deviation has none, though
its time constant or its harmonic may be known. What the motion contradicts, a cause says itself.
"""

from collections.abc import Sequence

import numpy as np

from ...arrays import Samples
from ..causes.protocol import Cause, FittedCause, Quantity, Setting
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Hypothesis


def has_plausible_size(fitter: HypothesisFitter, chosen: Hypothesis, index: int) -> bool:
    """Tell whether a member's torque and deviations make sense, and the motion does not contradict it."""
    member = chosen.members[index]
    at = Setting(fitter.dataset, fitter.operating_point, member.site, member.scalars)
    return (
        _within_torque(fitter, chosen, index)
        and _is_determined(fitter, chosen, index)
        and not member.cause.contradicted(at, chosen.solved(index))
    )


def _within_torque(fitter: HypothesisFitter, chosen: Hypothesis, index: int) -> bool:
    """Tell whether the torque of a member exceeds the joint's own on no joint; RMS over usable rows.

    What the joint's own friction and offset stand for says nothing: a spring's column is without its rest
    angle, and how a friction curve is split between a power and the Coulomb and viscous parts is arbitrary.
    """
    dataset, values = fitter.dataset, chosen.fit.values[chosen.columns_of(index)]
    for joint, own in fitter.columns([chosen.members[index]])[0].items():
        usable = dataset.usable[:, joint]
        effect, torque = own[usable] @ values, dataset.torque[usable, joint]
        effect -= _stood_for(dataset.state.velocity[usable, joint], effect)
        if effect @ effect > torque @ torque:
            return False
    return True


def _stood_for(speed: Samples, effect: Samples) -> Samples:
    """Give the part of a torque that offset, viscous and Coulomb friction represent."""
    own = np.column_stack([np.ones_like(speed), speed, np.sign(speed)])
    return np.asarray(own @ np.linalg.lstsq(own, effect, rcond=None)[0])


def _is_determined(fitter: HypothesisFitter, chosen: Hypothesis, index: int) -> bool:
    solved = chosen.in_joint_units(index, fitter.dataset.robot)
    return _exceeds_deviation(_sizes(chosen.members[index].cause, solved))


def has_known_size(cause: Cause, solved: FittedCause) -> bool:
    """Tell whether any number that says how large an effect is exceeds its deviation.

    An instant says from when on it acts, and a body that is told by its mass moment alone has no mass yet.
    """
    return _exceeds_deviation([size for size in _sizes(cause, solved) if not size.is_instant])


def _sizes(cause: Cause, solved: FittedCause) -> list[Quantity]:
    """Leave out the scalars that shape an effect, such as a time constant or a harmonic.

    An effect of no known size has a shape all the same, often with no deviation at all.
    """
    quantities = cause.quantities(solved)
    sizes = [one for one in quantities if one.is_instant or one.name not in solved.scalars]
    return sizes or list(quantities)


def _exceeds_deviation(quantities: Sequence[Quantity]) -> bool:
    return not quantities or bool(np.max([quantity.clearness for quantity in quantities]) > 1.0)
