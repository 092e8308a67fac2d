"""List what can be hidden by its public name, so that a case is drawn by a word."""

from tests.plant.effects.drive import (
    TorqueGain,
    TorqueGainNonlinear,
    TorqueOffsetDrift,
    TorqueRipple,
    TorqueSaturation,
)
from tests.plant.effects.effect import Effect
from tests.plant.effects.encoder import EncoderEccentricity, EncoderOffset, EncoderQuantization
from tests.plant.effects.friction import (
    Asymmetric,
    LoadDependent,
    PositionDependent,
    Presliding,
    Stribeck,
    Temperature,
    ViscousNonlinear,
)
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
    )
}
