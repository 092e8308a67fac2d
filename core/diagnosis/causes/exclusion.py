"""State what the structure of robot, motion and channel excludes, cause by cause, with the law behind it.

Bounds of signs and sizes are each cause's `admissible`, what the motion refutes is its `contradicted`, and
what no size could show is the search's `ScoredCandidate.determined`. This is the list that a user reads.
"""

from dataclasses import dataclass

from ..thresholds.causes import ADMISSIBLE
from ..thresholds.checks import ALTERNATIVES, SPRING_RESONANCE


@dataclass(frozen=True)
class Exclusion:
    """State where a cause is never named, or doubtful, and why."""

    cause: str
    where: str
    law: str


GENERAL: tuple[str, ...] = (
    "its torque, but for friction and offset, exceeds its joint's: another column cancels what is left open",
    "none of its numbers exceeds its own standard deviation",
    "the log leaves its size open beyond the largest admissible one, as of a vertical first joint's zero",
    "its sign or size is one of those below",
)
"""Where no cause is named."""

EXCLUSIONS: tuple[Exclusion, ...] = (
    Exclusion("friction_stribeck", "the excess is negative", "friction is largest next to standstill"),
    Exclusion(
        "friction_viscous_nonlinear",
        f"the exponent is within {ADMISSIBLE.power_distance:g} of 0 or 1",
        "that is Coulomb or viscous friction, which the model has",
    ),
    Exclusion(
        "friction_load_dependent",
        "the coefficient is negative or above 1",
        "friction brakes, and is less than the load that causes it",
    ),
    Exclusion(
        "friction_temperature",
        f"the warm-up takes less than {ADMISSIBLE.least_warm_up:g} s",
        "no drive of a robot warms up faster",
    ),
    Exclusion("friction_presliding", "the level is negative", "friction builds up against the motion"),
    Exclusion("joint_elasticity", "the stiffness is negative", "such a joint would not come to rest"),
    Exclusion(
        "backlash",
        "the gap differs many times from the one that its crossings were computed for",
        "the torque of a gap is where the link crosses it",
    ),
    Exclusion(
        "joint_coupling",
        "an inertia or friction of the coupled motor is significantly negative",
        "it is that of a motor",
    ),
    Exclusion("rotor_inertia_missing", "the inertia is negative", "it is that of a rotor"),
    Exclusion(
        "torque_ripple",
        f"it has less than {ADMISSIBLE.ripple_harmonic:g} cycles per revolution",
        "gravity has one",
    ),
    Exclusion(
        "torque_gain",
        "the joint has no load that another joint's torque or a reference contains, as without gravity and "
        "coupled inertia",
        "only ratios between joints show a gain; alone, the joint's own parameters are larger by that share",
    ),
    Exclusion(
        "torque_gain",
        f"the error is {100.0 * ADMISSIBLE.torque_gain:g} % or more",
        "a channel of the other sign is a conflict of robot and log",
    ),
    Exclusion(
        "torque_saturation",
        f"the torque that the motion shows exceeds the limit by more than "
        f"{100.0 * ADMISSIBLE.saturation_excess:g} %",
        "a drive at its limit applies the limit, and the motion shows what was applied",
    ),
    Exclusion("torque_saturation", "the command is below the torque applied", "a limit only takes away"),
    Exclusion("torque_saturation", "the log's torque never exceeds the limit", "the log keeps the command"),
    Exclusion(
        "time_delay",
        f"it exceeds {1e3 * ADMISSIBLE.time_delay:g} ms",
        "a first-order column does not represent it",
    ),
    Exclusion(
        "torque_filter_lag",
        f"the time constant is negative or above {1e3 * ADMISSIBLE.filter_lag:g} ms",
        "a filter lags, and one as slow leaves no motion in the torque",
    ),
    Exclusion(
        "position_filter",
        f"it amplifies, or its cut-off is below {ADMISSIBLE.lowest_cutoff:g} Hz",
        "a low-pass attenuates, and one as low leaves no motion",
    ),
    Exclusion(
        "encoder_offset",
        f"it exceeds {ADMISSIBLE.encoder_offset:g} rad",
        "the table belongs to another robot; quarter and half turns are conflicts of robot and log",
    ),
    Exclusion(
        "encoder_eccentricity",
        f"the amplitude exceeds {ADMISSIBLE.encoder_eccentricity:g} rad; above "
        f"{ADMISSIBLE.eccentricity_represented:g} rad the confidence is limited",
        "its first order errs by half of it, and a disc so far off its axis could not be read",
    ),
    Exclusion(
        "kinematic_error",
        f"it exceeds {ADMISSIBLE.kinematic_error:g} rad or m",
        "a first-order column does not represent it; long errors are conflicts of robot and log",
    ),
    Exclusion(
        "gravity_misalignment",
        f"the tilt exceeds {ADMISSIBLE.gravity_tilt:g} rad",
        "a first-order column does not represent it; larger ones are conflicts of robot and log",
    ),
    Exclusion(
        "payload_change",
        f"the mass exceeds {ADMISSIBLE.payload:g} kg or, against a reference or in one of several logs, the "
        "parameters are no body's",
        "a payload is a body",
    ),
    Exclusion("link_parameters", "the difference is that of a body", "a body that was attached is a payload"),
    Exclusion("cable_force", "the cable pushes", "a slack cable carries nothing"),
    Exclusion(
        "external_contact",
        f"the force exceeds {ADMISSIBLE.contact_force:g} N, or the moment what the force has at "
        f"{ADMISSIBLE.contact_lever:g} m",
        "it would break the robot, or does not act on its last link",
    ),
    Exclusion(
        "dropped_samples",
        f"the repeated rows, taken for measurements, would add less than {ALTERNATIVES.least_gain:g} % to "
        "every joint's RMS error",
        "they are listed with the log's defects",
    ),
)

DOUBTS: tuple[Exclusion, ...] = (
    Exclusion(
        "friction_viscous_nonlinear",
        f"the exponent is below {ADMISSIBLE.least_power:g}",
        "it differs from Coulomb friction next to reversals only, where much else leaves a residual",
    ),
    Exclusion(
        "friction_viscous_nonlinear",
        f"the exponent is within {ADMISSIBLE.significant:g} standard deviations of 0 or 1",
        "it may as well be Coulomb or linear friction, which the model has",
    ),
    Exclusion(
        "friction_load_dependent",
        f"the coefficient is above {ADMISSIBLE.load_friction:g}",
        "such a gear locks itself; the torque may be what a controller's own model leaves of it",
    ),
    Exclusion(
        "friction_presliding",
        f"the level is less than {ADMISSIBLE.level_deviations:g} standard deviations",
        "it may as well be Coulomb friction, which the model has",
    ),
    Exclusion(
        "friction_presliding",
        "a joint that lags behind the logged positions in a controller's loop explains the torque better",
        "the positions may be the reference, and dry friction holds a joint where its reference turns round",
    ),
    Exclusion(
        "joint_elasticity",
        f"the stiffness is more than {SPRING_RESONANCE.times:g} times that of its resonance and of the moved "
        "inertia, or as many times less",
        "what resonates is then not the link on its spring: a base that gives or a load that swings",
    ),
    Exclusion(
        "torque_ripple",
        f"the motion shows less than {ADMISSIBLE.ripple_waves:g} waves, or their number per revolution is "
        f"within {ADMISSIBLE.significant:g} standard deviations of {ADMISSIBLE.ripple_harmonic:g}",
        "so little of a wave may be any other torque over the angle, as of a hose or a spring balance",
    ),
    Exclusion(
        "torque_offset_drift",
        f"the time constant is below {ADMISSIBLE.least_warm_up:g} s",
        "no drive or sensor warms up faster; it is the state in which hysteretic friction begins the log",
    ),
    Exclusion(
        "time_delay",
        "the torque is ahead of the positions by less than one sample",
        "a controller holds a torque until its next sample: it acts half a sample later than it is logged",
    ),
    Exclusion(
        "encoder_eccentricity",
        f"the amplitude is above {ADMISSIBLE.eccentricity_represented:g} rad",
        "the first order of the error, which is fitted, omits a tenth of it",
    ),
)
"""Where a finding is doubtful: its confidence is 0.5 at most."""


def exclusions(cause: str) -> tuple[Exclusion, ...]:
    """List where a cause is not named."""
    return tuple(entry for entry in EXCLUSIONS if entry.cause == cause)


def doubts(cause: str) -> tuple[Exclusion, ...]:
    """List where a cause is doubtful."""
    return tuple(entry for entry in DOUBTS if entry.cause == cause)
