"""List what can be hidden by its public name, so that a case is drawn by a word."""

from tests.plant.effects.belief import GravityMisalignment, KinematicError
from tests.plant.effects.drive import (
    TorqueGain,
    TorqueGainNonlinear,
    TorqueOffsetDrift,
    TorqueRipple,
    TorqueSaturation,
)
from tests.plant.effects.effect import Effect
from tests.plant.effects.encoder import EncoderEccentricity, EncoderOffset, EncoderQuantization
from tests.plant.effects.foreign import (
    DragByOther,
    FrictionByOther,
    Sawtooth,
    Slosh,
    SpeedProduct,
    Telegraph,
)
from tests.plant.effects.friction import (
    Asymmetric,
    LoadDependent,
    PositionDependent,
    Presliding,
    Stribeck,
    Temperature,
    ViscousNonlinear,
)
from tests.plant.effects.surroundings import CableForce, ExternalContact, PayloadChange, SpringCompensator
from tests.plant.effects.timing import DroppedSamples, TimeDelay, TimestampJitter, TorqueFilterLag
from tests.plant.effects.transmission import Backlash, JointCoupling, JointElasticity, RotorInertiaMissing

EFFECTS: dict[str, type[Effect]] = {
    one.cause: one
    for one in (
        Stribeck,
        ViscousNonlinear,
        Asymmetric,
        LoadDependent,
        Temperature,
        PositionDependent,
        Presliding,
        JointElasticity,
        Backlash,
        JointCoupling,
        RotorInertiaMissing,
        TorqueRipple,
        TorqueGain,
        TorqueGainNonlinear,
        TorqueOffsetDrift,
        TorqueSaturation,
        TimeDelay,
        TorqueFilterLag,
        TimestampJitter,
        DroppedSamples,
        EncoderOffset,
        EncoderEccentricity,
        EncoderQuantization,
        KinematicError,
        GravityMisalignment,
        PayloadChange,
        SpringCompensator,
        CableForce,
        ExternalContact,
    )
}
"""Every cause that has a name."""

FOREIGN: dict[str, type[Effect]] = {
    one.cause: one for one in (SpeedProduct, FrictionByOther, DragByOther, Slosh, Telegraph, Sawtooth)
}
"""Effects that are in no list."""
