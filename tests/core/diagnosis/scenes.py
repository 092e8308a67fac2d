"""Make data sets of small robots and of the shipped arm, whose truth is known, for laws of the diagnosis."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy.interpolate import CubicSpline

from tests.core.dynamics.terms.motions import swinging
from tests.core.estimate.worlds import true_parameters
from tests.tools import Motion, pinocchio_torque, random_bodies
from veritorque.core.diagnosis.causes.protocol import Cause, Scalars, Setting, Site
from veritorque.core.diagnosis.dataset.dataset import Dataset, build_dataset
from veritorque.core.diagnosis.search.fitter import HypothesisFitter, hypothesis_fitter
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.estimate.gaussian_prior import GaussianPrior
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import RobotModel
from veritorque.core.signals.state import MotionState

UNTOUCHED = 0.1
"""Columns that change by less than this share of themselves hold no measured torque."""
SHOVE = (6.0, 6.8)
"""When something pushes, s: long enough to be seen, short enough to be an event."""


ARM_RATE_HZ = 250.0

Effect = Callable[[MotionState], np.ndarray]
"""Take a motion, give the torque (samples x joints, N m) that no standard model has."""


@dataclass(frozen=True, eq=False)
class Scene:
    """Hold a data set and its operating point."""

    dataset: Dataset
    operating_point: Prediction


def skew_arm() -> RobotModel:
    """Give three links with skew axes by their modified DH rows; the first joint's rotor is not declared."""
    row = {"type": "revolute", "theta_offset": 0.0}
    joints = [
        {**row, "alpha": 0.4, "d": 0.0, "r": 0.2, "rotor_inertia": False},
        {**row, "alpha": -1.3, "d": 0.1, "r": 0.05},
        {**row, "alpha": 1.1, "d": 0.3, "r": 0.1},
    ]
    return robot_from_description({"name": "skew", "joints": joints})


@cache
def eventful_scene() -> Scene:
    """Condition 12 s of three joints in which every cause has a site.

    The first joint lacks its rotor inertia, and something pushes against the arm for a while.
    """
    time, position, torque = recording()
    torque[(time > SHOVE[0]) & (time < SHOVE[1])] += [4.0, -3.0, 2.0]
    return scene_of(time, position, torque)


@cache
def spoilt_scenes() -> tuple[Scene, ...]:
    """Look at logs whose samples are not in order: late and early, coarse, repeated, too small to be read."""
    stamps, position, torque = recording()
    rng = np.random.default_rng(4)
    late = recording(jitter=2e-3)
    coarse = 1e-3 * np.round(position / 1e-3)
    lost = np.maximum.accumulate(np.where(rng.random(len(stamps)) < 0.02, 0, np.arange(len(stamps))))
    return (
        scene_of(stamps, *late[1:]),
        scene_of(stamps, coarse, torque),
        scene_of(stamps, position[lost], torque[lost]),
        scene_of(stamps, position, np.where(np.abs(torque) < 0.3, 0.0, torque)),
    )


def recording(jitter: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Record time, position and pinocchio's torque with noise of 0.05 N m; instants scatter by `jitter` s."""
    state = swinging(3, 12.0)
    time, rng = np.asarray(state.time), np.random.default_rng(3)
    really = time + jitter * rng.normal(size=len(time))
    series = [CubicSpline(time, one)(really) for one in (state.position, state.velocity, state.acceleration)]
    torque = pinocchio_torque(skew_arm(), bodies_of_skew_arm(), Motion(*series))
    return time, series[0], torque + 0.05 * rng.normal(size=torque.shape)


def scene_of(time: np.ndarray, position: np.ndarray, torque: np.ndarray) -> Scene:
    """Look at a log of the skew arm, its last fifth held out, and believe its true bodies."""
    robot = skew_arm()
    log = log_from_arrays("scene", time, position, torque)
    dataset = build_dataset(standard_model(robot), (log,), held_out=frozenset({(0, 4)}), blocks=5)
    return Scene(dataset, Prediction(standard_model(robot, ("rigid_body",)), bodies_of_skew_arm().ravel()))


def bodies_of_skew_arm() -> np.ndarray:
    """Give the arm's true bodies."""
    return random_bodies(np.random.default_rng(2), 3)


def first_choice(cause: Cause, scene: Scene) -> tuple[Site, Scalars]:
    """Give a cause's first site and grid point."""
    site = cause.sites(scene.dataset)[0]
    return site, cause.grid(Setting(scene.dataset, scene.operating_point, site))[0]


def change_with_measurement(cause: Cause, scene: Scene) -> float:
    """Give the share by which columns change when noise of half the torque's size is measured on top.

    A cause may look at the residual to choose where to search, so that a little change is no fault; a column
    that holds the measured torque changes by about as much.
    """
    dataset, (site, scalars) = scene.dataset, first_choice(cause, scene)
    noise = np.random.default_rng(5).normal(size=dataset.torque.shape) * 0.5 * np.std(dataset.torque, axis=0)
    both = [
        one.columns([cause.term(Setting(one, scene.operating_point, site, scalars))])[0]
        for one in (dataset, replace(dataset, torque=dataset.torque + noise))
    ]
    before, after = (np.hstack([one[joint] for joint in sorted(one)]) for one in both)
    return float(np.linalg.norm(after - before) / np.linalg.norm(before))


def measured_arm(
    effect: Effect | None = None, *, seed: int = 6, seconds: float = 20.0, noise: float = 0.05
) -> Scene:
    """Look at the skew arm with friction and rotors as the standard model has them, and an effect if given.

    Noise has a deviation of so many N m; the last fifth is held out.
    """
    model, state = standard_model(skew_arm()), swinging(3, seconds)
    truth = true_parameters(model)
    torque = model.torque(truth, state)
    torque += noise * np.random.default_rng(seed).normal(size=state.position.shape)
    if effect is not None:
        torque += effect(state)
    return look_at_arm(state.position, torque)


def look_at_arm(position: np.ndarray, torque: np.ndarray) -> Scene:
    """Look at a log of the skew arm at the rate and with the true parameters of `measured_arm`."""
    model, time = standard_model(skew_arm()), np.arange(len(position)) / ARM_RATE_HZ
    truth = true_parameters(model)
    log = log_from_arrays("arm", time, position, torque)
    dataset = build_dataset(model, (log,), held_out=frozenset({(0, 4)}), blocks=5)
    return Scene(dataset, Prediction(model, truth))


def fitter_of(scene: Scene, causes: Sequence[Cause], prior: GaussianPrior | None = None) -> HypothesisFitter:
    """Give the fitter of a scene with its candidate causes, linearised at the model alone."""
    model = scene.operating_point.model
    plan = ColumnPlan(model, base_model(model).kept)
    return linearised(hypothesis_fitter(scene.dataset, plan, causes, prior))


def linearised(fitter: HypothesisFitter) -> HypothesisFitter:
    """Linearise at the model alone."""
    return fitter.linearised_at(fitter.fit(()))
