"""List what can be hidden by its public name, so that a case is drawn by a word."""

from collections.abc import Iterator
from importlib import import_module
from inspect import isclass
from pkgutil import iter_modules

from tests.plant import effects
from tests.plant.effects.effect import Effect

PARAMETERS: dict[str, set[str]] = {
    "friction_stribeck": {"excess_torque", "stribeck_velocity"},
    "friction_viscous_nonlinear": {"coefficient", "exponent"},
    "friction_asymmetric": {"delta_viscous"},
    "friction_load_dependent": {"load_coefficient"},
    "friction_temperature": {"coulomb_slope", "viscous_slope", "time_constant"},
    "friction_position_dependent": {"amplitude", "harmonic", "phase"},
    "friction_presliding": {"presliding_distance"},
    "joint_elasticity": {"stiffness", "damping"},
    "backlash": {"half_width"},
    "joint_coupling": {"Fvm", "Fcm", "Iam"},
    "rotor_inertia_missing": {"IA"},
    "torque_ripple": {"amplitude", "harmonic", "phase"},
    "torque_gain": {"relative_error"},
    "torque_gain_nonlinear": {"cubic_coefficient"},
    "torque_offset_drift": {"total_drift"},
    "torque_saturation": {"limit"},
    "time_delay": {"delay"},
    "torque_filter_lag": {"time_constant"},
    "timestamp_jitter": {"std"},
    "dropped_samples": {"fraction"},
    "encoder_offset": {"offset"},
    "encoder_eccentricity": {"amplitude", "phase"},
    "encoder_quantization": {"lsb"},
    "kinematic_error": {"error"},
    "gravity_misalignment": {"tilt_x", "tilt_y"},
    "payload_change": {"mass", "com_x", "com_y", "com_z", "time"},
    "spring_compensator": {"stiffness"},
    "cable_force": {"stiffness", "engage_angle"},
    "external_contact": {"force"},
}
"""The enumeration of causes and of their parameters, as the public document names them, in drawing order."""


def _classes() -> Iterator[type[Effect]]:
    """List the effects of the folder that have a name, each where it is defined."""
    for found in iter_modules(effects.__path__, f"{effects.__name__}."):
        if not found.name.endswith(".registry"):
            for kind in vars(import_module(found.name)).values():
                own = isclass(kind) and kind.__module__ == found.name and issubclass(kind, Effect)
                if own and vars(kind).get("cause"):
                    yield kind


CLASSES: dict[str, type[Effect]] = {kind.cause: kind for kind in _classes()}
"""Every effect by its name."""

EFFECTS: dict[str, type[Effect]] = {cause: CLASSES[cause] for cause in PARAMETERS}
"""Every cause that has a name."""

FOREIGN: dict[str, type[Effect]] = {
    cause: kind for cause, kind in CLASSES.items() if cause.startswith("foreign_")
}
"""Effects that are in no list."""
