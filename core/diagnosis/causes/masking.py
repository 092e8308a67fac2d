"""State which causes mask or exclude others, and on what evidence.

What first-order columns leave of a large effect may resemble another cause: it is masked while the first one
is in the model. Two causes that would share one effect exclude each other. Causes that are nearly parallel to
first order, and the experiments that separate them, stand in `imitation`.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Masking:
    """Name the causes that are masked or excluded, and the evidence."""

    causes: tuple[str, ...]
    evidence: str


_LATE_TORQUE = Masking(
    ("friction_presliding", "friction_stribeck", "joint_elasticity"),
    "A first-order column is late where velocities reverse, which resembles friction, and it lacks the term "
    "in frequency squared. Of five examined logs (of 686) with Stribeck friction named beside a delay or "
    "filter, one had it.",
)
_LARGE_ANGLE = Masking(
    ("kinematic_error",),
    "What a first-order column leaves of a large angle resembles a small error of a length.",
)
_SAME_FIRST_ORDER = "Delay and low-pass filter agree to first order in frequency."

MASKED_BY: dict[str, Masking] = {
    "backlash": Masking(
        ("joint_elasticity", "time_delay", "torque_filter_lag"),
        "The link bounces and slides as it lands; the remainder resembles a spring or a delay.",
    ),
    "torque_saturation": Masking(
        ("external_contact",),
        "Torques near the limit are predicted with an error: beside a clipped torque, examined logs had a "
        "contact named at the same instants.",
    ),
    "time_delay": _LATE_TORQUE,
    "torque_filter_lag": _LATE_TORQUE,
    "encoder_eccentricity": Masking(("encoder_offset",), "The second order of a large wave has a mean."),
    "kinematic_error": Masking(
        ("spring_compensator", "cable_force", "kinematic_error"),
        "What first-order columns leave of a large error is a torque over the angle, or resembles a small "
        "error of another length.",
    ),
    "payload_change": Masking(
        ("external_contact",), "An instant that is slightly off leaves a short wrench on the same link."
    ),
}
"""Causes that the remainder of a cause resembles: beside it, they have to be nearly as clear. Of transient
causes only those count that act while it acts."""

EXCLUDED_BY: dict[str, Masking] = {
    "time_delay": Masking(("torque_filter_lag",), _SAME_FIRST_ORDER),
    "torque_filter_lag": Masking(("time_delay",), _SAME_FIRST_ORDER),
    "encoder_offset": _LARGE_ANGLE,
    "gravity_misalignment": _LARGE_ANGLE,
}
"""Causes that are not added once a cause is in the model: they would share one effect."""


def masks(cause: str) -> tuple[str, ...]:
    """List the causes that the remainder of a cause resembles."""
    return MASKED_BY[cause].causes if cause in MASKED_BY else ()


def excludes(cause: str) -> tuple[str, ...]:
    """List the causes that are not added beside a cause."""
    return EXCLUDED_BY[cause].causes if cause in EXCLUDED_BY else ()
