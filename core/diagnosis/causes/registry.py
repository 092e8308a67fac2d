"""List the candidate causes. CONTRIBUTING.md says what a new one needs besides its line here."""

from collections.abc import Mapping

from .backlash import Backlash
from .cable_force import CableForce
from .dropped_samples import DroppedSamples
from .encoder_eccentricity import EncoderEccentricity
from .encoder_offset import EncoderOffset
from .encoder_quantization import EncoderQuantization
from .external_contact import ExternalContact
from .friction_asymmetric import FrictionAsymmetric
from .friction_change import FrictionChange
from .friction_load_dependent import FrictionLoadDependent
from .friction_position_dependent import FrictionPositionDependent
from .friction_presliding import FrictionPresliding
from .friction_stribeck import FrictionStribeck
from .friction_temperature import FrictionTemperature
from .friction_viscous_nonlinear import FrictionViscousNonlinear
from .gravity_misalignment import GravityMisalignment
from .joint_coupling import JointCoupling
from .joint_elasticity import JointElasticity
from .kinematic_error import KinematicError
from .link_parameters import LinkParameters
from .payload_change import PayloadChange
from .position_filter import PositionFilter
from .protocol import Cause
from .rotor_inertia_missing import RotorInertiaMissing
from .sample_check import SampleCheck
from .spring_compensator import SpringCompensator
from .time_delay import TimeDelay
from .timestamp_jitter import TimestampJitter
from .torque_dead_zone import TorqueDeadZone
from .torque_filter_lag import TorqueFilterLag
from .torque_gain import TorqueGain
from .torque_gain_nonlinear import TorqueGainNonlinear
from .torque_offset_drift import TorqueOffsetDrift
from .torque_ripple import TorqueRipple
from .torque_saturation import TorqueSaturation

CAUSES: tuple[Cause, ...] = (
    FrictionStribeck(),
    FrictionViscousNonlinear(),
    FrictionAsymmetric(),
    FrictionLoadDependent(),
    FrictionTemperature(),
    FrictionPositionDependent(),
    FrictionPresliding(),
    JointElasticity(),
    Backlash(),
    JointCoupling(),
    RotorInertiaMissing(),
    TorqueRipple(),
    TorqueGain(),
    TorqueGainNonlinear(),
    TorqueOffsetDrift(),
    TorqueSaturation(),
    TimeDelay(),
    TorqueFilterLag(),
    PositionFilter(),
    EncoderOffset(),
    EncoderEccentricity(),
    KinematicError(),
    GravityMisalignment(),
    PayloadChange(),
    SpringCompensator(),
    CableForce(),
    ExternalContact(),
)
"""Causes that add torque."""

CHANGES: tuple[Cause, ...] = (
    PayloadChange(throughout=True),
    LinkParameters(),
    FrictionChange(),
    TorqueGain(together=True),
)
"""Causes that are observable only against a reference: without one the base parameters absorb them."""

ONLY_CHANGES: tuple[Cause, ...] = tuple(
    change for change in CHANGES if change.id not in {cause.id for cause in CAUSES}
)
"""Those of them that have no counterpart within a log."""
AGAINST_REFERENCE: tuple[Cause, ...] = (*CHANGES, *CAUSES)
"""Causes that add torque to what a reference predicts."""
SAMPLE_CHECKS: tuple[SampleCheck, ...] = (
    DroppedSamples(),
    TimestampJitter(),
    EncoderQuantization(),
    TorqueDeadZone(),
)
"""Causes that are found in the raw samples."""

BY_ID: Mapping[str, Cause | SampleCheck] = {
    **{cause.id: cause for cause in (*CAUSES, *ONLY_CHANGES)},
    **{check.id: check for check in SAMPLE_CHECKS},
}
