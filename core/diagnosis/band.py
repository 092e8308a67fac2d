"""Look no higher than the positions allow: above some frequency their own noise rules the residual.

Noise of a position grows with the square of frequency on its way to a torque. Where it does, the columns
themselves are noisy, every coefficient is drawn towards zero at high frequencies, and a delay or a filter
would seem to explain it. Source: Fuller, Measurement Error Models (1987), ch. 1.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from core.arrays import JointSeries, JointVector
from core.diagnosis.look import BAND_OVER_MOTION, Look
from core.diagnosis.noise import JointNoise, places
from core.diagnosis.raw import disturbance
from core.dynamics.prediction import Prediction
from core.robot.parameters import INERTIAL_SYMBOLS

LARGEST_SHARE = 0.05
"""Share of a joint's mean square residual that the positions' noise may have."""
NARROWEST = 10.0
"""A look is at least as wide as the fit's own filter, ten times the motion's band."""
_DIFFERENCES = 4
_SUM_OF_SQUARES = 70.0
"""Of the coefficients 1, -4, 6, -4, 1."""
_LOOKS = 4

Fitted = tuple[Look, Prediction, tuple[JointNoise, ...]]


def narrowed(look_again: Callable[[float], Fitted]) -> Fitted:
    """Narrow a look until the noise of the positions has little share in any joint's residual.

    Parameters
    ----------
    look_again
        Gives the look of a width (band over the motion's band), what a plain fit then believes, and the noise
        it leaves.
    """
    width = BAND_OVER_MOTION
    look, believed, noise = look_again(width)
    shares = position_noise_share(look, believed, noise)
    for _ in range(_LOOKS):
        share = float(np.max(shares))
        if share <= LARGEST_SHARE or width <= NARROWEST:
            break
        actual = look.band_hz / look.motion_band_hz
        width = max(NARROWEST, min(width, actual) * float(np.clip((LARGEST_SHARE / share) ** 0.2, 0.5, 0.85)))
        look, believed, noise = look_again(width)
        shares = position_noise_share(look, believed, noise)
    return replace(look, position_share=shares), believed, noise


def position_noise_share(look: Look, believed: Prediction, noise: tuple[JointNoise, ...]) -> JointVector:
    """Give, per joint, the share of the white residual's mean square that noise of the positions has."""
    size = position_noise(look)

    def spoil(position: JointSeries, velocity: JointSeries, rng: np.random.Generator) -> JointSeries:
        del velocity
        return size * rng.normal(size=position.shape)

    place = places(~look.starts)
    gained = disturbance(look, _frictionless(believed), spoil)
    shares = []
    for joint, one in enumerate(noise):
        white = one.whitened(gained[:, [joint]], place)[look.usable[:, joint]]
        shares.append(float(np.sum(white**2)) / max(len(white), 1))
    return np.array(shares)


def _frictionless(believed: Prediction) -> Prediction:
    """Leave out what jumps with the sign of velocity: there rows stand for themselves."""
    kept = np.array(
        [one.symbol in {*INERTIAL_SYMBOLS, "IA", "IAM"} for one in believed.model.parameters], dtype=bool
    )
    return Prediction(believed.model, np.where(kept, believed.standard, 0.0), believed.newton_euler)


def position_noise(look: Look) -> JointVector:
    """Give the positions' noise per joint from sample to sample, rad or m, by fourth differences."""
    found = []
    for motion in look.motions:
        start, stop = max(motion.log.segments, key=lambda one: one[1] - one[0])
        rows = motion.log.source.rows(start, min(stop, start + 65536))
        jumps = np.diff(rows.position, _DIFFERENCES, axis=0)
        found.append(np.sqrt(np.mean(jumps**2, axis=0) / _SUM_OF_SQUARES))
    return np.asarray(np.max(found, axis=0))
