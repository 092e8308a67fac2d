"""List warnings about a successful identification, in sentences with numbers.

An optimum exists even where a log contradicts itself or the description, and for poor excitation.
"""

from collections.abc import Sequence

import numpy as np

from ..arrays import Mask
from ..estimate.constraints import link_columns
from ..estimate.plausibility import DENSEST
from ..log.model import Defect
from ..regressor.factor import REGRESSOR
from ..robot.extent import Extent
from ..robot.joint_units import prismatic_joints
from ..robot.plausibility import unit_warnings
from .choice import BIASED
from .computed_torque import looks_computed
from .contradictions import contradictions
from .result import Identification

EXACT_PERCENT = 0.1
"""Error that no sensor of torque tells from none."""
MUCH_WORSE = 2.0
"""Error of an iteration over that of the least squares it began at. Free motion over windows, which minimises
another error, leaves 1.7 times as much on a simulated arm where both are exact; on measured arms where it
does not converge 4 to 50 times. Set by hand."""
ONE_DIRECTION = "one_direction"
SOURCES = {
    "declared": "as declared",
    "shapes": "from the shapes of its description",
    "axes": "assumed from the distances between axes",
}
MISSING = "missing_torque"
DOUBTFUL = (
    "implausible_unit",
    "velocity_mismatch",
    "position_is_reference",
    "shared_position",
    "unsigned_torque",
    "unknown_sign",
    MISSING,
    ONE_DIRECTION,
)
"""Defects of a log by which values are wrong, or not known, however well the model fits."""
LEAST_SQUARES = ("sdp", "wls", "irls", "ols")
"""Estimators that noise of columns biases."""
_DOES_NOT_EXCITE = "The motion does not excite"
FAR_FROM_DESCRIBED = 10.0
"""Factor between the torques of the identified and of the described bodies that is another unit's, a gear's
or a placeholder's. Described masses are seldom wrong by more than two or three. Set by hand."""


def doubts(found: Identification) -> tuple[str, ...]:
    """List the warnings."""
    return (
        *_description(found),
        *_logs(found),
        *_scale(found),
        *looks_computed(found),
        *contradictions(found),
        *_not_converged(found),
        *_worse_than_least_squares(found),
        *_attenuated(found),
        *_not_excited(found),
    )


def _description(found: Identification) -> list[str]:
    """Repeat what says that the description is in other units; of several lengths or angles the first."""
    return [f"The description: {one}" for one in unit_warnings(found.base.model.robot)[:1]]


def _not_converged(found: Identification) -> list[str]:
    ended = found.convergence
    return [] if ended.converged else [f"The estimator {found.estimator} did not converge: {ended.reason}"]


def _worse_than_least_squares(found: Identification) -> list[str]:
    """Doubt an iteration that explains less than the least squares it began at, where noise is no reason."""
    before, after = found.start_percent, found.judged_percent
    noisy = np.max(np.nan_to_num(np.abs(found.attenuation.missed)), initial=0.0) > BIASED
    if before is None or noisy or after <= MUCH_WORSE * max(before, EXACT_PERCENT):
        return []
    sentence = (
        f"The estimator {found.estimator} leaves {after:.3g} % of the torque, the least squares "
        f"that it began at leaves {before:.3g} %, and noise of positions does not explain "
        "that: its simulation may not follow the log. Use estimator sdp, or other options of the simulation"
    )
    return [sentence]


def _attenuated(found: Identification) -> list[str]:
    told = found.attenuation
    sizes = np.nan_to_num(np.abs(told.missed))
    noisy = np.flatnonzero(sizes > BIASED)
    if found.estimator not in LEAST_SQUARES or not len(noisy):
        return []
    joints = ", ".join(f"joint {joint + 1} by about {100.0 * sizes[joint]:.2g} %" for joint in noisy)
    sentence = (
        f"Positions are too noisy for a band of {told.cutoff_hz:.3g} Hz: least squares is biased in the "
        f"inertia of {joints}. Use estimator cloe, piv or ml, or a lower filter.cutoff_hz"
    )
    return [sentence]


def _logs(found: Identification) -> list[str]:
    """List the defects that put any fit of the logs in doubt, of several joints the first in full."""
    sentences = []
    for log in found.logs:
        for kind in DOUBTFUL:
            if kind == ONE_DIRECTION and len(found.logs) > 1:
                continue  # the way back may be in another log
            alike = [defect for defect in log.defects if defect.kind == kind]
            if alike:
                sentences.append(f"Log {log.name}: {_summarised(alike)}")
    return sentences


def _scale(found: Identification) -> list[str]:
    """Doubt the unit of all torques together: a common factor makes other bodies, and fits as well."""
    factor = _over_described(found)
    if factor is None or 1.0 / FAR_FROM_DESCRIBED < factor < FAR_FROM_DESCRIBED:
        return []
    sentence = (
        f"The identified bodies need {factor:.3g} times the torque of the described ones: the torque may be "
        "in another unit, in per cent or measured at the motor's side of a gear; or the described masses are "
        "placeholders, or leave out rotors behind gears"
    )
    return [sentence]


def _over_described(found: Identification) -> float | None:
    """Give the torque of the identified bodies over that of the described ones; None without these.

    The factor is that of least squares. Newtons are not added to newton metres.
    """
    model = found.base.model
    if model.robot.prior is None:
        return None
    described, identified = np.zeros((2, len(model.parameters)))
    for body, numbers in zip(model.robot.prior, link_columns(model), strict=True):
        described[list(numbers)] = body
        identified[list(numbers)] = found.estimate.standard[list(numbers)]
    products = np.zeros((2, 2))
    sliding = prismatic_joints(model.robot).astype(int)
    parts = zip(found.observation.joint_factors(), found.observation.columns_of, sliding, strict=True)
    for factor, columns, kind in parts:
        own, other = (
            factor.columns(REGRESSOR) @ found.base.base_of(bodies)[columns]
            for bodies in (described, identified)
        )
        products[kind] += own @ other, own @ own
    needed = products[products[:, 1] > 0.0]
    factors = needed[:, 0] / needed[:, 1]
    return float(np.mean(factors)) if len(factors) and np.mean(factors) > 0.0 else None


def _summarised(alike: Sequence[Defect]) -> str:
    """State the first of some defects of one kind in full, and the joints of the others."""
    others = ", ".join(str(defect.joint) for defect in alike[1:])
    return alike[0].statement.rstrip(".") + (f" (likewise on joints {others})" if others else "")


def _sizes(found: Identification) -> list[str]:
    """List the links whose bound on size or density contradicts the log."""
    sentences = []
    for costly in found.estimate.costly:
        link, extent = costly.bound.link, costly.bound.extent
        size = "" if extent is None else f", all within {_ball(extent)} ({SOURCES[extent.source]})"
        kept = extent is not None and extent.source == "declared"
        done = "kept, because it is declared" if kept else "removed: the body is larger or denser"
        sentences.append(
            f"A plausible body of link {link} (no denser than {DENSEST:g} kg/m3{size}) raises the squared "
            f"error by a factor of {costly.ratio:.3g}. This bound was {done}; give the link's true size "
            "(option bounds.size), or check log and description"
        )
    return sentences


def _ball(extent: Extent) -> str:
    centre = ", ".join(f"{value:.3g}" for value in extent.ball.centre)
    return f"{extent.ball.radius:.3g} m of ({centre}) m"


def _not_excited(found: Identification) -> list[str]:
    unknown = ~np.isfinite(found.precision.standard_deviation)
    unexcited = np.diag(found.precision.information) == 0.0
    sentences = []
    if unexcited.any():
        missing = any(defect.kind == MISSING for log in found.logs for defect in log.defects)
        source = "The motion and the torques that were measured do not show" if missing else _DOES_NOT_EXCITE
        sentences.append(f"{source} {_names(found, unexcited)}: their values are those of the prior")
    if (unknown & ~unexcited).any():
        sentences.append(
            f"The motion does not separate {_names(found, unknown & ~unexcited)}: "
            "only combinations of them are determined, the prior selects among these"
        )
    return sentences


def _names(found: Identification, marked: Mask) -> str:
    rows = np.flatnonzero(marked)
    more = f" and {len(rows) - 10} more" if len(rows) > 10 else ""
    return ", ".join(found.base.names[row] for row in rows[:10]) + more
