"""List the causes that are suspected: adding one is one file in `causes` and one line here."""

from collections.abc import Mapping

from core.diagnosis.causes.backlash import Backlash
from core.diagnosis.causes.cable_force import CableForce
from core.diagnosis.causes.dropped_samples import DroppedSamples
from core.diagnosis.causes.encoder_eccentricity import EncoderEccentricity
from core.diagnosis.causes.encoder_offset import EncoderOffset
from core.diagnosis.causes.encoder_quantization import EncoderQuantization
from core.diagnosis.causes.external_contact import ExternalContact
from core.diagnosis.causes.friction_asymmetric import FrictionAsymmetric
from core.diagnosis.causes.friction_change import FrictionChange
from core.diagnosis.causes.friction_load_dependent import FrictionLoadDependent
from core.diagnosis.causes.friction_position_dependent import FrictionPositionDependent
from core.diagnosis.causes.friction_presliding import FrictionPresliding
from core.diagnosis.causes.friction_stribeck import FrictionStribeck
from core.diagnosis.causes.friction_temperature import FrictionTemperature
from core.diagnosis.causes.friction_viscous_nonlinear import FrictionViscousNonlinear
from core.diagnosis.causes.gravity_misalignment import GravityMisalignment
from core.diagnosis.causes.joint_coupling import JointCoupling
from core.diagnosis.causes.joint_elasticity import JointElasticity
from core.diagnosis.causes.kinematic_error import KinematicError
from core.diagnosis.causes.link_parameters import LinkParameters
from core.diagnosis.causes.payload_change import PayloadChange
from core.diagnosis.causes.protocol import Cause
from core.diagnosis.causes.rotor_inertia_missing import RotorInertiaMissing
from core.diagnosis.causes.sample_check import RawCause
from core.diagnosis.causes.spring_compensator import SpringCompensator
from core.diagnosis.causes.time_delay import TimeDelay
from core.diagnosis.causes.timestamp_jitter import TimestampJitter
from core.diagnosis.causes.torque_filter_lag import TorqueFilterLag
from core.diagnosis.causes.torque_gain import TorqueGain
from core.diagnosis.causes.torque_gain_nonlinear import TorqueGainNonlinear
from core.diagnosis.causes.torque_offset_drift import TorqueOffsetDrift
from core.diagnosis.causes.torque_ripple import TorqueRipple
from core.diagnosis.causes.torque_saturation import TorqueSaturation

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
"""Causes that show only against a reference: without one the base parameters absorb them."""

ONLY_CHANGES: tuple[Cause, ...] = tuple(
    one for one in CHANGES if one.id not in {other.id for other in CAUSES}
)
"""Those of them that have no counterpart within a log."""

AGAINST_REFERENCE: tuple[Cause, ...] = (*CHANGES, *CAUSES)
"""Causes that add torque to what a reference predicts."""

RAW_CAUSES: tuple[RawCause, ...] = (DroppedSamples(), TimestampJitter(), EncoderQuantization())
"""Causes that show in the raw samples."""

BY_ID: Mapping[str, Cause | RawCause] = {
    **{one.id: one for one in (*CAUSES, *ONLY_CHANGES)},
    **{one.id: one for one in RAW_CAUSES},
}
