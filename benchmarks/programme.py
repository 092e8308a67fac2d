"""The semidefinite programme for 7, 14 and 30 links: Clarabel called directly, and through cvxpy.

Its size depends on the robot alone; the log is behind it as one factor.
"""

from functools import partial

import numpy as np

from benchmarks.figures import Figure, processor_seconds
from benchmarks.scene import NOISE_SHARE, Scene, scene_of, smooth_motion
from veritorque.core.estimate.constraints import Bounds, default_prior
from veritorque.core.estimate.programme import Programme
from veritorque.core.estimate.system import weighted
from veritorque.core.estimate.with_clarabel import solve_with_clarabel
from veritorque.core.estimate.with_cvxpy import solve_with_cvxpy
from veritorque.core.regressor.factor import Factor
from veritorque.core.robot.builtin import builtin_robot
from veritorque.core.robot.frames import rotation_rpy
from veritorque.core.robot.model import Joint, Link, RobotModel

TARGETS_MS = {7: 15, 14: 60, 30: 400}
_SAMPLES = 400


def run(*, quick: bool) -> list[Figure]:
    """Solve with both and compare time and optimum."""
    robots = [builtin_robot("yumi-left"), builtin_robot("yumi")] + ([] if quick else [_long_chain(30)])
    figures: list[Figure] = []
    for robot in robots:
        links = len(robot.links)
        programme = programme_of(scene_of(robot))
        repeats = 3 if quick or links > 20 else 7
        ours = processor_seconds(partial(solve_with_clarabel, programme), repeats=repeats, least=0.0)
        theirs = processor_seconds(partial(solve_with_cvxpy, programme), repeats=1, least=0.0)
        base, system = programme.base, programme.system
        costs = [
            system.cost(base.base_of(solve(programme).standard))
            for solve in (solve_with_clarabel, solve_with_cvxpy)
        ]
        gap = abs(costs[0] - costs[1]) / costs[1]
        figures += [
            Figure(
                f"{links} links, ms",
                f"{1e3 * ours:.1f}",
                f"<= {TARGETS_MS[links]}",
                f"cvxpy {1e3 * theirs:.0f}",
            ),
            Figure(f"{links} links, times faster than cvxpy", f"{theirs / ours:.1f}", "", ratio=True),
            Figure(f"{links} links, relative difference of the misfit", f"{gap:.1e}", "<= 1e-4", ratio=True),
        ]
    return figures


def programme_of(scene: Scene) -> Programme:
    """State the programme of noisy samples of a smooth motion."""
    joints = len(scene.robot.joints)
    rng = np.random.default_rng(11)
    state = smooth_motion(joints).at(np.sort(rng.uniform(0.0, 600.0, _SAMPLES)))
    torque = scene.torque(state)
    rms = np.sqrt(np.mean(torque**2, axis=0))
    torque = torque + NOISE_SHARE * rms * rng.normal(size=torque.shape)
    series = scene.plan.series(state)
    factors = tuple(
        Factor.of(np.vstack([series[rows], torque[:, joint]]).T)
        for joint, rows in enumerate(scene.plan.rows_of)
    )
    system = weighted(factors, scene.plan.columns_of, len(scene.plan.columns))
    return Programme(scene.base, system, default_prior(scene.model, rms), Bounds())


def _long_chain(count: int) -> RobotModel:
    rng = np.random.default_rng(13)
    links = tuple(
        Link(
            name=f"link_{number}",
            kind="revolute",
            antecedent=number - 1,
            joint=number,
            rotation=rotation_rpy(*rng.uniform(-np.pi, np.pi, 3)),
            translation=rng.normal(scale=0.1, size=3),
        )
        for number in range(1, count + 1)
    )
    joints = tuple(Joint(f"joint_{number}") for number in range(1, count + 1))
    return RobotModel(f"chain of {count}", links, joints, np.array([0.0, 0.0, -9.81]))
