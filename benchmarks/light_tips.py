"""Arms whose last link is light, a point mass or nothing at all: how many of 200 the default solver leaves.

The bodies of wrists and tools weigh a thousandth of the arm's, so that the columns of the equations differ
by many decades and the margin of an ordinary link would contradict the log.
"""

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from benchmarks.figures import Figure
from veritorque.core.dynamics.model import DynamicModel, standard_model
from veritorque.core.errors import SolverError
from veritorque.core.estimate.constraints import default_prior
from veritorque.core.estimate.estimate import Estimate, estimate
from veritorque.core.estimate.options import EstimateOptions
from veritorque.core.estimate.system import weighted
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan
from veritorque.core.regressor.factor import Factor
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import INERTIAL_SYMBOLS, RobotModel
from veritorque.core.signals.state import MotionState

TIPS = ((0.0, 0.0), *product((0.02, 0.2), (0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4)))
"""Mass (kg) and principal moments about the mass centre (kg m2) of the last link."""
NOISES = (0.003, 0.03)
"""Torque noise as a share of the joint's torque."""
SHAPES = (6, 3)
"""Numbers of joints."""
_CASES = 200
_SAMPLES = 600
_BODIES = ((6.0, 0.05), (9.0, 0.2), (4.0, 0.02), (3.0, 0.02), (1.5, 0.003), (0.6, 0.001))


@dataclass(frozen=True)
class Case:
    """State one arm and its log."""

    joints: int
    mass: float
    inertia: float
    noise: float
    prior: bool
    seed: int


def cases() -> Iterator[Case]:
    """List cases, the seed last to change: 120 with each seed."""
    for seed in range(1_000_000):
        for joints, (mass, inertia), noise, prior in product(SHAPES, TIPS, NOISES, (True, False)):
            yield Case(joints, mass, inertia, noise, prior, seed)


def run(*, quick: bool) -> list[Figure]:
    """Estimate all and count what no solver answered, and what it cost to be physically consistent."""
    begin, failures, costs = time.process_time(), 0, []
    count = 8 if quick else _CASES
    for case, _ in zip(cases(), range(count), strict=False):
        try:
            found = solved(case)
        except SolverError:
            failures += 1
        else:
            costs.append(found.objective / found.objective_unconstrained)
    spent = (time.process_time() - begin) / count
    return [
        Figure(f"failures of {count}", str(failures), "0", ratio=True),
        Figure("largest cost of consistency, over least squares", f"{max(costs):.3f}", "<= 1.05", ratio=True),
        Figure("time of one, ms", f"{1e3 * spent:.0f}"),
    ]


def solved(case: Case, solver: str = "clarabel") -> Estimate:
    """Estimate the parameters of a case.

    Raises
    ------
    SolverError
        If the solver reports no optimum.
    """
    rng = np.random.default_rng([case.seed, case.joints])
    robot = _arm(case, rng)
    model = standard_model(robot)
    base = base_model(model)
    plan = ColumnPlan(model, base.kept)
    state = _swing(rng, case.joints)
    torque = model.torque(_truth(model, state), state)
    rms = np.sqrt((torque**2).mean(axis=0))
    torque = torque + case.noise * rms * rng.normal(size=torque.shape)
    series = plan.series(state)
    factors = tuple(
        Factor.of(np.vstack([series[rows], torque[:, joint]]).T) for joint, rows in enumerate(plan.rows_of)
    )
    system = weighted(factors, plan.columns_of, len(plan.columns))
    known = model if case.prior else replace(model, robot=replace(robot, prior=None))
    return estimate(
        replace(base, model=known), system, default_prior(known, rms), EstimateOptions(solver=solver)
    )


def _arm(case: Case, rng: np.random.Generator) -> RobotModel:
    quarter = np.pi / 2
    twists = (0.0, -quarter, 0.0, quarter, -quarter, quarter)[: case.joints]
    rows = [
        {"type": "revolute", "alpha": twist, "d": d, "r": r, "theta_offset": 0.0}
        for twist, d, r in zip(
            twists, rng.uniform(0.0, 0.4, case.joints), rng.uniform(0.0, 0.3, case.joints), strict=True
        )
    ]
    bodies = [
        {
            "mass": mass,
            "center_of_mass": rng.normal(scale=0.05, size=3).tolist(),
            "inertia_at_com": _ball(size),
        }
        for mass, size in (*_BODIES[: case.joints - 1], (case.mass, case.inertia))
    ]
    return robot_from_description({"name": "light tip", "joints": rows, "prior": bodies})


def _ball(size: float) -> list[float]:
    return [size, 0.0, 0.0, size, 0.0, size]


def _swing(rng: np.random.Generator, joints: int) -> MotionState:
    """Draw instants of a motion of five sines per joint."""
    angular = 2.0 * np.pi * rng.uniform(0.1, 1.0, (5, joints))
    size = rng.uniform(0.2, 0.6, (5, joints)) / np.sqrt(angular)
    phase = rng.uniform(0.0, 25.0, (_SAMPLES, 1, 1)) * angular + rng.uniform(0.0, 2.0 * np.pi, (5, joints))
    return MotionState(
        (size * np.sin(phase)).sum(axis=1),
        (size * angular * np.cos(phase)).sum(axis=1),
        (-size * angular**2 * np.sin(phase)).sum(axis=1),
    )


def _truth(model: DynamicModel, state: MotionState) -> np.ndarray:
    """Give the bodies of the prior, and drives in proportion to the torque that the bodies need."""
    prior = model.robot.prior if model.robot.prior is not None else np.zeros((0, 10))
    values = np.array(
        [
            prior[one.number - 1, INERTIAL_SYMBOLS.index(one.symbol)]
            if one.symbol in INERTIAL_SYMBOLS
            else 0.0
            for one in model.parameters
        ]
    )
    torque = np.sqrt((model.torque(values, state) ** 2).mean(axis=0))
    torque = np.maximum(torque, 1e-3 * torque.max())
    fast, quick = (np.sqrt((one**2).mean(axis=0)) for one in (state.velocity, state.acceleration))
    shares = {
        "IA": 0.2 * torque / quick,
        "FV": 0.15 * torque / fast,
        "FC": 0.1 * torque,
        "OFF": 0.02 * torque,
    }
    for column, one in enumerate(model.parameters):
        if one.symbol in shares:
            values[column] = shares[one.symbol][one.number - 1]
    return values
