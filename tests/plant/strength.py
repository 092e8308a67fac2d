"""Measure how strong a hidden effect is: what of it the standard model cannot absorb, over the noise.

The standard model is ten inertial parameters per link, rotor inertia, friction, offset and declared couplings
of the robot *as believed*, with pinocchio's regressor along the motion as noise-free sensors see it. Coulomb
friction enters with the direction that it really had; while it holds a joint, where it balances whatever
comes, its torque may be anything, since nobody who sees the log knows it. Torque and columns are compared
below 20 Hz, in the frequency domain: what lies above is lost to whoever has to differentiate encoders.
Strength is the RMS of what the model leaves of the noise-free torque, over the RMS of the noise, on the joint
where that is largest; the oracle's noncentrality is ||(I - P) S^-1/2 e||^2 with S the true spectrum of the
noise. Where the angles themselves are spoilt (jitter, repeats, a coarse step), e is the error that
differentiating them makes.
"""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pinocchio as pin
from scipy import signal
from scipy.stats import chi2, ncx2

from tests.plant.effects.effect import Signals
from tests.plant.mechanism import build, inverse
from tests.plant.robots import Arm
from tests.plant.sensors import counted, spectrum
from veritorque.core.robot.model import RobotModel

BAND_HZ = 20.0
"""What a log's user can make use of: derivatives of quantised positions are noise above."""
LEVEL, POWER = 1e-3, 0.9
AT_LEVEL = 0.999
"""Share of its level from which on Coulomb friction slides."""
SPANNED = 1e-6
"""Singular value, over the largest, below which a direction is rounding."""


@dataclass(frozen=True, eq=False)
class Residue:
    """Hold what the standard model leaves of one effect.

    Attributes
    ----------
    strength
        RMS below 20 Hz over the noise's whole RMS, per joint.
    whitened
        What is left of the whitened torque below 20 Hz; its squared length is the noncentrality.
    """

    strength: np.ndarray
    whitened: np.ndarray

    @property
    def noncentrality(self) -> float:
        """Give lambda."""
        return float(self.whitened @ self.whitened)


def residue(
    robot: RobotModel, signals: Signals, torque: np.ndarray, noise_rms: np.ndarray, kind: str
) -> Residue:
    """Take the standard model of the believed robot out of a torque (N m)."""
    if not np.isfinite(torque).all():
        return Residue(np.full(torque.shape[1], np.nan), np.full(1, np.nan))
    rate_hz = 1.0 / (signals.time[1] - signals.time[0])
    rows = np.concatenate([regressor(robot, signals) @ distinguishable(robot), torque[:, :, None]], axis=2)
    frequency = np.fft.rfftfreq(len(torque), 1.0 / rate_hz)
    frequency = frequency[frequency <= BAND_HZ]
    waves = _waves(rows / noise_rms[:, None], len(frequency))
    held = [_waves(shapes, len(frequency)) for shapes in _held(robot, signals, rate_hz)]
    left = _left(waves, held)
    strength = np.sqrt(np.sum(left**2, axis=(0, 1)) / len(torque))
    deviation = np.sqrt(spectrum(kind, frequency, rate_hz))
    white = [shapes / deviation[:, None] for shapes in held]
    return Residue(strength, _left(waves / deviation[:, None, None], white).ravel())


def nameable(noncentrality: float) -> bool:
    """Tell whether the test that knows the effect finds it nine times in ten at a level of 1e-3.

    Examples
    --------
    >>> nameable(20.0), nameable(22.0)
    (False, True)
    """
    return bool(ncx2.sf(chi2.isf(LEVEL, 1), 1, noncentrality) >= POWER)


def given(whitened: np.ndarray, others: list[np.ndarray]) -> float:
    """Give the noncentrality of one effect where the others' sizes are not known either."""
    if not others:
        return float(whitened @ whitened)
    columns = np.column_stack(others)
    left = whitened - columns @ np.linalg.lstsq(columns, whitened)[0]
    return float(left @ left)


def regressor(robot: RobotModel, signals: Signals) -> np.ndarray:
    """Give the standard model's columns, samples x joints x parameters."""
    model = _pinocchio(robot)
    data = model.createData()
    samples, joints = signals.position.shape
    rigid = np.empty((samples, joints, 10 * len(robot.links)))
    motion = (signals.position, signals.velocity, signals.acceleration)
    for row, sample in enumerate(zip(*motion, strict=True)):
        rigid[row] = pin.computeJointTorqueRegressor(model, data, *sample)
    own = [signals.acceleration, signals.velocity, signals.direction, np.ones((samples, joints))]
    places = np.eye(joints)
    held = [np.array([joint.rotor_inertia for joint in robot.joints], dtype=float), *np.ones((3, joints))]
    blocks = [rigid, *(series[:, :, None] * places * on for series, on in zip(own, held, strict=True))]
    for place, coupling in enumerate(robot.couplings):
        weights = np.zeros(joints)
        weights[np.array(coupling.joints) - 1] = coupling.weights
        sums = [signals.acceleration @ weights, signals.velocity @ weights, signals.motor_direction[:, place]]
        blocks.append(np.column_stack(sums)[:, None, :] * weights[:, None])
    return np.concatenate(blocks, axis=2)


def differentiation_error(arm: Arm, ideal: Signals, spoilt: Signals) -> np.ndarray:
    """Give the torque error (N m) that a log with spoilt instants or angles makes below 20 Hz.

    Both logs go through a zero-phase low-pass and flat differences; their torques through the true arm
    differ by the error, less what the logged torque itself changed by.
    """
    rate_hz = 1.0 / (ideal.time[1] - ideal.time[0])
    low = signal.butter(4, BAND_HZ, fs=rate_hz, output="sos")
    model = build(replace(arm, robot=replace(arm.robot, couplings=())))
    needed = []
    for one in (ideal, spoilt):
        position = signal.sosfiltfilt(low, counted(one), axis=0)
        velocity = _slope(position, rate_hz)
        acceleration = _slope(velocity, rate_hz)
        drives = arm.rotor_inertia * acceleration + arm.viscous * velocity
        needed.append(inverse(model, (position, velocity, acceleration)) + drives)
    logged = spoilt.torque[spoilt.kept] - ideal.torque
    return np.asarray(signal.sosfiltfilt(low, logged, axis=0) - (needed[1] - needed[0]))


def _slope(values: np.ndarray, rate_hz: float) -> np.ndarray:
    """Differentiate along time by seven samples; within three of an end by fewer."""
    flat = signal.convolve(
        values, np.array([[1.0, -9.0, 45.0, 0.0, -45.0, 9.0, -1.0]]).T / 60.0, mode="valid"
    )
    slope = np.gradient(values, 1.0 / rate_hz, axis=0)
    slope[3:-3] = rate_hz * flat
    return np.asarray(slope)


@cache
def distinguishable(robot: RobotModel) -> np.ndarray:
    """Span the parameter directions that any motion at all can show (columns orthonormal)."""
    rng = np.random.default_rng(0)
    joints = len(robot.joints)
    q, dq, ddq, direction = rng.uniform(-3.0, 3.0, (4, 100, joints))
    couplings = rng.uniform(-1.0, 1.0, (100, len(robot.couplings)))
    random = Signals(np.arange(100.0), q, dq, ddq, q, direction, couplings, q, 1, q[0], np.arange(100))
    rows = regressor(robot, random)
    _, singular, directions = np.linalg.svd(rows.reshape(-1, rows.shape[2]), full_matrices=False)
    return np.asarray(directions[singular > 1e-9 * singular[0]].T)


def _held(robot: RobotModel, signals: Signals, rate_hz: float) -> list[np.ndarray]:
    """Give, per joint, samples x shapes: all that friction may do below 20 Hz while it holds the joint.

    Polynomials over every stretch of time in which Coulomb friction is not at its level.
    """
    held = np.abs(signals.direction) < AT_LEVEL
    for place, coupling in enumerate(robot.couplings):
        motor = np.abs(signals.motor_direction[:, place]) < AT_LEVEL
        held[:, np.array(coupling.joints) - 1] |= motor[:, None]
    out = []
    for marks in held.T:
        edges = np.flatnonzero(np.diff(np.pad(marks.astype(int), 1)))
        shapes = [np.zeros((len(marks), 0))]
        for begin, end in edges.reshape(-1, 2):
            count = min(end - begin, 2 + int(np.ceil(2.0 * BAND_HZ * (end - begin) / rate_hz)))
            one = np.zeros((len(marks), count))
            one[begin:end] = np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, end - begin), count - 1)
            shapes.append(one)
        out.append(np.hstack(shapes))
    return out


def _waves(series: np.ndarray, count: int) -> np.ndarray:
    """Give the first Fourier coefficients of real series, whose squares add up to the series' own."""
    waves = np.fft.rfft(series, axis=0)[:count] * np.sqrt(2.0 / len(series))
    waves[0] /= np.sqrt(2.0)
    return np.asarray(waves)


def _left(waves: np.ndarray, held: list[np.ndarray]) -> np.ndarray:
    """Project the last column on the complement of the others; give parts x frequencies x joints.

    Each joint's rows lose what their own `held` shapes span first. Then by the normal equations of scaled
    columns, whose condition is that of a well excited arm.
    """
    parts = np.stack([waves.real, waves.imag])
    for joint, shapes in enumerate(held):
        spanned, sizes, _ = np.linalg.svd(np.concatenate([shapes.real, shapes.imag]), full_matrices=False)
        basis = spanned[:, sizes > SPANNED * sizes.max(initial=0.0)]
        own = parts[:, :, joint].reshape(-1, parts.shape[-1])
        parts[:, :, joint] = (own - basis @ (basis.T @ own)).reshape(parts[:, :, joint].shape)
    rows = parts.reshape(-1, parts.shape[-1])
    length = np.maximum(np.linalg.norm(rows, axis=0), np.finfo(float).tiny)
    columns, last = rows[:, :-1] / length[:-1], rows[:, -1] / length[-1]
    fitted = columns @ np.linalg.lstsq(columns.T @ columns, columns.T @ last, rcond=1e-13)[0]
    return np.asarray((last - fitted) * length[-1]).reshape(parts.shape[:-1])


@cache
def _pinocchio(robot: RobotModel) -> pin.Model:
    model = pin.Model()
    model.gravity.linear = np.asarray(robot.gravity)
    carrier = 0
    for link in robot.links:
        placement = pin.SE3(link.rotation, link.translation)
        carrier = model.addJoint(carrier, pin.JointModelRZ(), placement, link.name)
    return model
