"""Test whether the robot is mounted otherwise than described, so that gravity has another direction."""

from collections.abc import Callable, Iterator
from itertools import product
from typing import Any

import numpy as np
from scipy.optimize import fmin

from ...arrays import Vector3
from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..thresholds import MOUNTING
from ..trial import Trials

Bound = Callable[[np.ndarray], np.ndarray]
_COARSE = np.array([way for way in product((-1.0, 0.0, 1.0), repeat=3) if any(way)])
_COARSE /= np.linalg.norm(_COARSE, axis=1)[:, None]
"""The axes of the base, and the directions halfway between two and three of them."""
_USUAL = _COARSE[np.count_nonzero(_COARSE, axis=1) < 3]

_REFINEMENT: Any = {
    "initial_simplex": [[0.0, 0.0], [0.3, 0.0], [0.0, 0.3]],
    "xtol": 1e-3,
    "ftol": 1e-5,
    "maxfun": 60,
    "disp": False,
}
"""Steps of a third of a radian, refined to a milliradian."""


class Mounting(Conflict):
    """Let gravity have any direction."""

    name = "mounting"
    title = "Mounting of the robot"

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Refine the likeliest direction of gravity and its opposite, and the likeliest far from both.

        A mere tilt is among them, so that nothing else is named in its place (see `refinement`).
        """
        described = np.asarray(setup.robot.gravity, dtype=float)
        size = float(np.linalg.norm(described))
        if size == 0.0:
            return
        bound = trials.under_gravity(setup)
        likely = _likely(lambda way: bound(size * way))
        for way in (one for found in likely for one in _with_usual(found)):
            gravity = size * way
            if np.allclose(gravity, described):
                continue
            listed = ", ".join(f"{component + 0.0:.3g}" for component in gravity)
            yield Hypothesis(
                self.name,
                (),
                None,
                setup.with_gravity(gravity),
                f"gravity is [{listed}] m/s2 in the base frame, "
                f"{np.degrees(_angle(way, described)):.0f} degrees from the described direction",
                f"describe the robot with gravity [{listed}]",
            )


def is_tilt(gravity: Vector3, described: Vector3) -> bool:
    """Tell whether gravity is so near the described direction that this is a cause, and no conflict."""
    return _angle(gravity, described) < MOUNTING.least_angle


def _likely(bound: Bound) -> Iterator[Vector3]:
    """Give directions worth a trial; a planar arm cannot distinguish a direction from its mirror image."""
    scores = bound(_COARSE)
    first = _COARSE[np.argmin(scores)]
    apart = np.array([min(_angle(way, first), _angle(way, -first)) > MOUNTING.apart for way in _COARSE])
    best = _refined(first, bound)
    apart &= ~np.isclose(scores, bound(best))
    yield best
    yield -best
    if apart.any():
        yield _COARSE[apart][np.argmin(scores[apart])]


def _refined(first: Vector3, bound: Bound) -> Vector3:
    """Minimise over the sphere from a direction, in two coordinates of its tangent plane."""
    plane = np.linalg.svd(first[None, :])[2][1:]

    def direction(step: np.ndarray) -> Vector3:
        way = first + step @ plane
        return np.asarray(way / np.linalg.norm(way))

    def lost(step: np.ndarray) -> float:
        return float(bound(direction(step)))

    return direction(fmin(lost, np.zeros(2), **_REFINEMENT))


def _with_usual(way: Vector3) -> Iterator[Vector3]:
    """Give the usual mounting that is a mere tilt away, which noise may hide, then the direction itself."""
    nearest = min(_USUAL, key=lambda usual: _angle(way, usual))
    if is_tilt(way, nearest):
        yield nearest
    yield way


def _angle(first: Vector3, second: Vector3) -> float:
    cosine = first @ second / (np.linalg.norm(first) * np.linalg.norm(second))
    return float(np.arccos(np.clip(cosine, -1.0, 1.0)))
