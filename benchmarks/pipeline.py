"""Conditioning, regressor, parallel filter, decimation and accumulation, against pinocchio, scipy and lstsq.

The peer stores the whole observation matrix, filters it with `sosfiltfilt` and solves by `lstsq`; parameters
are compared on the same instants, two seconds away from the log's ends.
"""

import numpy as np
from scipy import signal

from benchmarks.figures import Figure, processor_seconds
from benchmarks.peer import base_columns, pinocchio_model
from benchmarks.scene import NOISE_SHARE, RATE_HZ, Scene, smooth_motion, yumi_arm
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.regressor.observe import observe
from veritorque.core.regressor.rows import equations
from veritorque.core.signals.condition import Motion, condition
from veritorque.core.signals.recipe import FilterOptions
from veritorque.core.signals.state import MotionState

TRIM_SECONDS = 2.0
ORDER, CUTOFF_HZ, POSITION_CUTOFF_HZ, DECIMATION = 5, 10.0, 50.0, 10
DIFFERENCE = np.array([1.0, -9.0, 45.0, 0.0, -45.0, 9.0, -1.0]) / 60.0
OPTIONS = FilterOptions(
    median_order=1,
    cutoff_hz=CUTOFF_HZ,
    position_cutoff_hz=POSITION_CUTOFF_HZ,
    order=ORDER,
    decimation=DECIMATION,
)


def run(*, quick: bool) -> list[Figure]:
    """Time both on one log and compare the parameters."""
    samples = 4_000 if quick else 20_000
    scene = yumi_arm()
    time = np.arange(samples) / RATE_HZ
    state = smooth_motion(7).at(time)
    torque = scene.torque(state)
    noise = np.random.default_rng(1).normal(size=torque.shape) * NOISE_SHARE * torque.std(axis=0)
    log = log_from_arrays("pipeline", time, state.position, torque + noise)
    motion = condition(log, scene.robot, OPTIONS)
    ours = processor_seconds(lambda: observe(scene.plan, (motion,)), repeats=3) / samples * 1e6
    answers: list[np.ndarray] = []
    theirs = processor_seconds(
        lambda: answers.append(_peer(scene, state.position, torque + noise)), repeats=1
    )
    theirs *= 1e6 / samples
    own = _solved(*_our_rows(scene, motion))
    gap = float(np.linalg.norm((own - answers[-1]) * _spread(scene)) / np.linalg.norm(own * _spread(scene)))
    return [
        Figure("log in memory to factors, us/sample", f"{ours:.2f}", "", f"pinocchio + scipy {theirs:.1f}"),
        Figure("times faster than the peer", f"{theirs / ours:.1f}", ">= 20", ratio=True),
        Figure("parameters, relative difference", f"{gap:.1e}", "<= 1e-8", "the peer's", ratio=True),
    ]


def _peer(scene: Scene, position: np.ndarray, torque: np.ndarray) -> np.ndarray:
    low = signal.butter(ORDER, POSITION_CUTOFF_HZ, fs=RATE_HZ, output="sos")
    smooth = signal.sosfiltfilt(low, position, axis=0)
    velocity = _differentiated(smooth)
    acceleration = _differentiated(velocity)
    W = base_columns(pinocchio_model(scene.robot), scene.base, MotionState(smooth, velocity, acceleration))
    band = signal.butter(ORDER, CUTOFF_HZ, fs=RATE_HZ, output="sos")
    filtered = signal.sosfiltfilt(band, W, axis=0)[::DECIMATION]
    target = signal.sosfiltfilt(band, torque, axis=0)[::DECIMATION]
    edge = round(TRIM_SECONDS * RATE_HZ / DECIMATION)
    return _solved(filtered[edge:-edge].reshape(-1, W.shape[2]), target[edge:-edge].reshape(-1))


def _differentiated(values: np.ndarray) -> np.ndarray:
    """Differentiate by seven samples; what lies next to the ends is trimmed."""
    return np.asarray(
        signal.lfilter(DIFFERENCE * RATE_HZ, [1.0], np.pad(values, ((0, 3), (0, 0))), axis=0)[3:]
    )


def _our_rows(scene: Scene, motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Write our equations out at the instants the peer keeps, standstill included."""
    W: list[np.ndarray] = []
    target: list[np.ndarray] = []
    for tile in motion.tiles():
        whole = np.zeros((len(tile.time), 7, len(scene.plan.columns)))
        torque = np.zeros((len(tile.time), 7))
        for joint, ((rows, _), columns) in enumerate(
            zip(equations(scene.plan, tile), scene.plan.columns_of, strict=True)
        ):
            whole[:, joint, columns] = rows[:, :-1]
            torque[:, joint] = rows[:, -1]
        W.append(whole)
        target.append(torque)
    edge = round(TRIM_SECONDS * RATE_HZ / motion.recipe.decimation)
    matrix = np.concatenate(W)[edge:-edge]
    return matrix.reshape(-1, matrix.shape[2]), np.concatenate(target)[edge:-edge].reshape(-1)


def _solved(W: np.ndarray, target: np.ndarray) -> np.ndarray:
    return np.asarray(np.linalg.lstsq(W, target, rcond=None)[0])


def _spread(scene: Scene) -> np.ndarray:
    """Give a size for each parameter, so that masses do not drown inertias."""
    return np.asarray(1.0 / (np.abs(scene.base.base_of(scene.truth)) + 1e-3))
