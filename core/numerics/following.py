"""Follow a mass along a series, compiled: on a spring, between stops, or in a loop with dry friction.

Source: Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I (1993), ch. II, for steps.
"""

# ruff: noqa: ANN001  # numba reads types from its own signatures, or infers them
# Nor does mypy read those signatures:
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit

_EXACT = {"nogil": True, "cache": True, "no_cfunc_wrapper": True, "error_model": "numpy"}
_COEFFICIENTS = "Tuple((float64[::1], float64[::1], float64[::1], float64[::1]))"


@njit(f"void(float64[::1], float64, {_COEFFICIENTS}, float64[::1])", **_EXACT)
def swing_freely(pulls, step, coefficients, followed) -> None:  # pragma: no cover  (compiled)
    """Write where an oscillator is whose coefficients are those of each sample (see `swing`).

    Parameters
    ----------
    coefficients
        Squared angular frequency, decay, what is left of a swing after a step, and the cosine of the angle
        that it swings by.
    """
    squares, decays, kept, cosine = coefficients
    before = now = pulls[0] / squares[0]
    for sample in range(len(pulls)):
        followed[sample] = now
        square, pull = squares[sample], pulls[sample]
        once, twice = 2.0 * kept[sample] * cosine[sample], kept[sample] ** 2
        late = 2.0 * decays[sample] / square
        rest, slope = (1.0 - once + twice) / square, (1.0 - twice) / square
        bend = (1.0 + twice) / square - 2.0 * (late / step) * slope
        first = slope - late / step * rest
        second = bend + 2.0 * rest * (late**2 - 1.0 / square) / step**2
        behind = pull - pulls[max(sample - 1, 0)]
        ahead = pulls[min(sample + 1, len(pulls) - 1)] - pull
        driven = rest * pull + 0.5 * first * (ahead + behind) + 0.5 * second * (ahead - behind)
        before, now = now, driven + once * now - twice * before


@njit("void(float64[::1], float64, float64, float64[::1])", **_EXACT)
def move_between_stops(pulls, step, half_width, twist) -> None:  # pragma: no cover  (compiled)
    """Write where something is between two stops that neither bounce nor pull: it rests there or flies.

    Parameters
    ----------
    pulls
        Its acceleration wherever it is free, per s2; `step` is the time between samples, s.
    half_width
        Where the stops are, on either side of zero; it begins at the one that it is pulled against.
    """
    if len(pulls) == 0:
        return
    position, rate = np.copysign(half_width, pulls[0]), 0.0
    for sample in range(len(pulls)):
        rate += step * pulls[sample]
        free = position + step * rate - 0.5 * step * step * pulls[sample]
        position = min(max(free, -half_width), half_width)
        if position != free:
            rate = 0.0
        twist[sample] = position


@njit("void(float64[::1], float64[::1], float64, UniTuple(float64, 4), float64[::1])", **_EXACT)
def follow_with_friction(velocity, acceleration, step, loop, pulled) -> None:  # pragma: no cover  (compiled)
    """Write what a loop pulls with, over its friction, while a mass with dry friction follows a reference.

    The mass sticks where the pull is less than friction. The steps are halved until the loop is slow in them.

    Parameters
    ----------
    velocity, acceleration
        Those of the reference, per s and per s2.
    loop
        Stiffness and damping of the loop over the mass, 1/s2 and 1/s; friction over the mass, the
        acceleration that it brakes with; and the share of the reference's acceleration that is fed forward.
    """
    stiffness, damping, friction, fed = loop
    parts = max(1, int(np.ceil(step * np.sqrt(stiffness) / 0.02)))
    part = step / parts
    own = velocity[0]
    lag = np.sign(velocity[0]) * friction / stiffness + (1.0 - fed) * acceleration[0] / stiffness
    for row in range(len(velocity)):
        last = max(row - 1, 0)
        for number in range(parts):
            share = (number + 1.0) / parts
            speed = velocity[last] + share * (velocity[row] - velocity[last])
            pull = fed * (acceleration[last] + share * (acceleration[row] - acceleration[last]))
            free = own + part * (pull + stiffness * lag + damping * (speed - own))
            own = np.sign(free) * max(abs(free) - part * friction, 0.0)
            lag += part * (speed - own)
        pulled[row] = (stiffness * lag + damping * (velocity[row] - own)) / friction
