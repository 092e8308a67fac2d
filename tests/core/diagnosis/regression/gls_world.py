"""Make equations whose every matrix can be written down: rows of three joints in noise of three colours."""

from dataclasses import replace

import numpy as np
from scipy.linalg import block_diag
from scipy.sparse import csr_array, hstack

from tests.core.diagnosis.processes import SLOW, WAVY, WHITE, dense_covariance, drawn, exact_noise
from tests.core.diagnosis.scenes import eventful_scene
from veritorque.core.diagnosis.dataset.dataset import Dataset
from veritorque.core.diagnosis.regression.ar_noise import ARNoise
from veritorque.core.diagnosis.regression.rows import Columns, JointRows, append_columns, rows_of_joints

PROCESSES = (WHITE, SLOW, WAVY)
NOISE: tuple[ARNoise, ...] = tuple(exact_noise(weights) for weights in PROCESSES)
BASE = np.array([1.0, -2.0, 0.5, 3.0])
FREE = 3
"""Columns of any size on the second joint."""


class Equations:
    """Hold rows with gaps, base columns, free columns on one joint, and noise that differs between joints.

    Parameters
    ----------
    effect
        What is added to the torque, rows x joints; the base parameters are `BASE` in any case.
    """

    def __init__(self, seed: int = 0, effect: np.ndarray | float = 0.0, *, free: int = FREE) -> None:
        rng = np.random.default_rng(seed)
        dataset = eventful_scene().dataset
        self.count = len(dataset.time)
        self.mask = rng.random((self.count, 3)) > 0.03
        self.base = tuple(smooth(rng, self.count, len(BASE)) for _ in range(3))
        noise = np.hstack([drawn(weights, rng, self.count) for weights in PROCESSES])
        self.nuisance = smooth(rng, self.count, free)
        torque = np.column_stack([one @ BASE for one in self.base]) + noise + effect
        torque[:, 1] += self.nuisance @ np.arange(1.0, free + 1.0)
        none = csr_array((self.count, 0))
        self.dataset: Dataset = replace(
            dataset, torque=torque, sticking=(none, csr_array(self.nuisance), none)
        )
        self.joints: tuple[JointRows, ...] = self.again()

    def again(self) -> tuple[JointRows, ...]:
        """Take the rows anew, after a change of the data set."""
        return rows_of_joints(self.dataset, self.base, self.mask)

    def with_rests(self) -> tuple[JointRows, ...]:
        """Let friction be anything on all joints for half of the time, in short stretches."""
        rests = short_polynomials(self.count)
        sticking = tuple(csr_array(hstack([one, rests])) for one in self.dataset.sticking)
        return rows_of_joints(replace(self.dataset, sticking=sticking), self.base, self.mask)

    def with_columns(self, *columns: Columns) -> tuple[JointRows, ...]:
        """Append candidates' columns."""
        return append_columns(self.joints, columns)

    def dense(self, *columns: Columns) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Write all columns (base, candidates', free), torque and covariance of all joints' rows at once."""
        parts, torque, covariances = [], [], []
        for joint, rows in enumerate(self.joints):
            kept = np.flatnonzero(self.mask[:, joint])
            width = next(iter(columns[0].values())).shape[1] if columns else 0
            nothing = np.zeros((self.count, width))
            own = [one.get(joint, nothing) for one in columns]
            free = self.nuisance if joint == 1 else np.zeros_like(self.nuisance)
            parts.append(np.hstack([self.base[joint], *own, free])[kept])
            torque.append(self.dataset.torque[kept, joint])
            covariances.append(dense_covariance(PROCESSES[joint], rows.run_index))
        return np.vstack(parts), np.concatenate(torque), block_diag(*covariances)


def smooth(rng: np.random.Generator, count: int, columns: int) -> np.ndarray:
    """Draw columns that vary slowly, as a filter leaves them."""
    raw = rng.normal(size=(count + 8, columns))
    return np.array([np.convolve(one, np.hanning(11)[1:-1], mode="valid") for one in raw.T]).T[:count]


def short_polynomials(count: int, *, every: int = 40, rows: int = 20, degree: int = 5) -> csr_array:
    """Put polynomials on so many rows of every so many, and nothing between."""
    shapes = np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, rows), degree)
    starts = range(every // 4, count - rows, every)
    columns = np.zeros((count, len(starts), degree + 1))
    for place, start in enumerate(starts):
        columns[start : start + rows, place] = shapes
    return csr_array(columns.reshape(count, -1))
