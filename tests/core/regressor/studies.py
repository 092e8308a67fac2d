"""Make a log of a YuMi arm whose torque comes from pinocchio, and the matrix that scipy would make of it."""

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from scipy import ndimage, signal

from tests.core.signals.motions import Multisine
from tests.tools import Motion, pinocchio_model, pinocchio_torque, random_bodies
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.builtin import builtin_robot
from veritorque.core.robot.model import RobotModel

RATE_HZ = 250.0
ORDER = 5
CUTOFF_HZ = 10.0
POSITION_CUTOFF_HZ = 40.0
DECIMATION = 10
PINOCCHIO = ("M", "MX", "MY", "MZ", "XX", "XY", "YY", "XZ", "YZ", "ZZ")


@dataclass(frozen=True, eq=False)
class Recorded:
    """Hold a robot, its bodies and a log of its swing; friction and offset are in the torque, and noise."""

    robot: RobotModel
    bodies: np.ndarray
    log: JointLog
    position: np.ndarray
    torque: np.ndarray


def recorded(seconds: float = 24.0, *, noise: float = 0.05) -> Recorded:
    """Record an arm that swings."""
    rng = np.random.default_rng(1)
    robot = builtin_robot("yumi-left")
    bodies = random_bodies(rng, 7)
    time = np.arange(int(seconds * RATE_HZ)) / RATE_HZ
    swing = Multisine.random(rng, 7)
    position, velocity, acceleration = (swing.derivative(time, order) for order in range(3))
    torque = pinocchio_torque(robot, bodies, Motion(position, velocity, acceleration))
    torque += 0.3 * acceleration + 0.5 * velocity + 0.4 * np.sign(velocity) + 0.1
    torque += noise * rng.normal(size=torque.shape)
    measured = position + 1e-5 * rng.normal(size=position.shape)
    return Recorded(robot, bodies, log_from_arrays("swing", time, measured, torque), measured, torque)


def filtered_by_scipy(series: np.ndarray, cutoff_hz: float) -> np.ndarray:
    """Run scipy's zero-phase Butterworth filter along the samples."""
    return signal.sosfiltfilt(signal.butter(ORDER, cutoff_hz, fs=RATE_HZ, output="sos"), series, axis=0)


def _without_absurd(position: np.ndarray) -> np.ndarray:
    """Take the median of five where a sample is off by four bends of the medians six samples around."""
    medians = signal.medfilt(position, 5)
    bends = np.abs(np.convolve(medians, [1.0, -2.0, 1.0], mode="same"))
    nearby = ndimage.grey_dilation(bends, size=13)
    return np.where(np.abs(position - medians) > 4.0 * nearby, medians, position)


def _derivative_by_scipy(series: np.ndarray) -> np.ndarray:
    """Differentiate by the weights that are exact for polynomials up to order six."""
    powers = np.vander(np.arange(-3.0, 4.0), increasing=True).T
    weights = np.linalg.solve(powers, np.eye(7)[1])
    return RATE_HZ * ndimage.correlate1d(series, weights, axis=0, mode="nearest")


def observation_by_scipy(study: Recorded) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Give every column by its name and the torque, decimated samples by joints, without any code of ours."""
    smooth = filtered_by_scipy(
        np.column_stack([_without_absurd(one) for one in study.position.T]), POSITION_CUTOFF_HZ
    )
    velocity = _derivative_by_scipy(smooth)
    acceleration = _derivative_by_scipy(velocity)
    model = pinocchio_model(study.robot, study.bodies)
    data = model.createData()
    rigid = np.array(
        [
            pin.computeJointTorqueRegressor(model, data, *state)
            for state in zip(smooth, velocity, acceleration, strict=True)
        ]
    )
    kept = filtered_by_scipy(rigid, CUTOFF_HZ)[::DECIMATION]
    columns = {
        f"{symbol}{link + 1}": kept[:, :, 10 * link + place]
        for link in range(7)
        for place, symbol in enumerate(PINOCCHIO)
    }
    own = {"IA": acceleration, "FV": velocity, "FC": np.sign(velocity), "OFF": np.ones_like(velocity)}
    for symbol, series in own.items():
        thinned = filtered_by_scipy(series, CUTOFF_HZ)[::DECIMATION]
        for joint in range(7):
            columns[f"{symbol}{joint + 1}"] = thinned * (np.arange(7) == joint)
    return columns, filtered_by_scipy(study.torque, CUTOFF_HZ)[::DECIMATION]
