"""Make residuals whose truth is known: the shipped arm's motion, its model's torque, noise and an effect."""

from dataclasses import dataclass, replace
from functools import cache, cached_property
from pathlib import Path

import numpy as np
from scipy.signal import lfilter

from veritorque.core.diagnosis.dataset.dataset import Dataset, build_dataset
from veritorque.core.diagnosis.regression.ar_noise import ARNoise
from veritorque.core.diagnosis.regression.gls import fit
from veritorque.core.diagnosis.regression.rows import JointRows, rows_of_joints
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.log.reader import read_log
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan
from veritorque.core.robot.builtin import builtin_robot

EXAMPLE = Path(__file__).parents[4] / "examples" / "yumi" / "log.csv"
NOISES = ("white", "ar_0.8", "ar_0.98", "student_3", "hum")
RATE_HZ = 250.0


@dataclass(frozen=True, eq=False)
class World:
    """Hold a data set, its operating point, and the model's own torque at its rows."""

    dataset: Dataset
    operating_point: Prediction
    plan: ColumnPlan
    torque: np.ndarray

    def left(self, disturbance: np.ndarray) -> tuple[np.ndarray, tuple[ARNoise, ...]]:
        """Add a disturbance (rows x joints) to the model's torque and fit: residual and noise models."""
        torque = self.torque + disturbance
        rows = enumerate(self.rows)
        found = fit(tuple(replace(one, torque=torque[one.rows, joint]) for joint, one in rows))
        predicted = np.column_stack([one @ found.values for one in self.columns])
        return torque - predicted, tuple(one.noise for one in found.joints)

    @cached_property
    def columns(self) -> tuple[np.ndarray, ...]:
        """Give the model's columns, which no disturbance changes."""
        return self.dataset.observed(self.plan)

    @cached_property
    def rows(self) -> tuple[JointRows, ...]:
        """Give every joint's rows without a disturbance."""
        return rows_of_joints(self.dataset, self.columns, self.dataset.clear)

    def noise(self, kind: str, seed: int) -> np.ndarray:
        """Draw noise at the log's rate and pass it through the data set's filter; of unit RMS per joint."""
        segment = self.dataset.motions[0].segments[0]
        raw = drawn(kind, np.random.default_rng(seed), segment.samples, self.dataset.joints)
        rows = segment.parallel.apply(np.ascontiguousarray(raw.T), 0, segment.kept).T
        return rows / np.std(rows, axis=0)


def drawn(kind: str, rng: np.random.Generator, samples: int, joints: int) -> np.ndarray:
    """Draw noise of unit variance at the log's rate; the hum comes on top of white noise as strong."""
    white = rng.normal(size=(samples, joints))
    if kind.startswith("ar_"):
        memory = float(kind.removeprefix("ar_"))
        white = rng.normal(size=(samples + 500, joints))
        return lfilter([np.sqrt(1.0 - memory**2)], [1.0, -memory], white, axis=0)[500:]
    if kind == "student_3":
        return rng.standard_t(3, size=(samples, joints)) / np.sqrt(3.0)
    if kind == "hum":
        return white + np.sqrt(2.0) * np.sin(2.0 * np.pi * 50.0 / RATE_HZ * np.arange(samples))[:, None]
    return white


WIDTH = 40.0
"""Ratio of the band to the motion's at which the log's period of 12 s is a whole number of rows."""


@cache
def world() -> World:
    """Look at the shipped log, and believe what a fit to it finds."""
    model = standard_model(builtin_robot("yumi-left"))
    plan = ColumnPlan(model, base_model(model).kept)
    dataset = build_dataset(model, (read_log(EXAMPLE),), held_out=frozenset(), blocks=20, width=WIDTH)
    columns = dataset.observed(plan)
    found = fit(rows_of_joints(dataset, columns, dataset.clear))
    standard = np.zeros(len(model.parameters))
    standard[list(plan.columns)] = found.values
    torque = np.column_stack([one @ found.values for one in columns])
    return World(dataset, Prediction(model, standard), plan, torque)


def on_joint(world: World, joint: int, effect: np.ndarray) -> np.ndarray:
    """Put an effect (rows) of unit RMS on one joint, counted from 1."""
    out = np.zeros_like(world.torque)
    out[:, joint - 1] = effect / np.std(effect)
    return out
