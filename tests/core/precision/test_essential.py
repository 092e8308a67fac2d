"""Hold the elimination of weak parameters: negligible ones leave, strong ones stay, the path is kept."""

from dataclasses import replace

import numpy as np

from tests.core.estimate.worlds import planar_robot, world_of
from veritorque.core.estimate.system import System
from veritorque.core.precision.essential import Essential, essential_parameters
from veritorque.core.precision.inference import INTERVAL_95, Inference


def _white(system: System) -> Inference:
    information = system.triangle.T @ system.triangle
    return Inference(information, information, np.zeros(len(information)), np.ones(2))


def _problem(values: np.ndarray, seed: int = 0, rows: int = 400) -> tuple[System, Essential]:
    rng = np.random.default_rng(seed)
    W = rng.normal(size=(rows, len(values)))
    y = W @ values + rng.normal(size=rows)
    Q, R = np.linalg.qr(W)
    rest = float(y @ y - (Q.T @ y) @ (Q.T @ y))
    system = System(R, Q.T @ y, rest, rows, np.ones(1))
    return system, essential_parameters(system, _white(system))


def test_negligible_parameters_leave_and_strong_ones_stay():
    # A unit-variance column of 400 rows tells a value to 0.05: 2 is strong, 0.001 is nothing.
    values = np.array([2.0, 0.001, -2.0, 0.0, 1.0])
    for seed in range(5):
        _, essential = _problem(values, seed)
        assert {0, 2, 4} <= set(essential.kept.tolist())
    kept = [len(_problem(values, seed)[1].kept) for seed in range(40)]
    # Each of the two negligible ones stays by chance in five cases of a hundred.
    assert np.mean(kept) - 3.0 < 0.35


def test_the_path_names_every_step_from_the_weakest_on_and_its_cost_only_grows():
    values = np.array([2.0, 0.02, -2.0, 0.0, 0.01, 1.0])
    system, essential = _problem(values, 1)
    gone = [step.parameter for step in essential.path]
    assert sorted([*gone, *essential.kept.tolist()]) == list(range(6))
    costs = [step.cost for step in essential.path]
    assert costs == sorted(costs)
    assert all(step.ratio <= INTERVAL_95 for step in essential.path)
    # The last cost is that of a fit with the kept columns alone, done here anew.
    columns = system.triangle[:, essential.kept]
    _, squares, *_ = np.linalg.lstsq(columns, system.target)
    expected = float(np.sum(squares)) + system.rest
    np.testing.assert_allclose(costs[-1], expected, rtol=1e-9)


def test_one_parameter_always_stays():
    _, essential = _problem(np.zeros(3), 2)
    assert len(essential.kept) >= 1


def test_parameters_that_nothing_excites_leave_first():
    world = world_of(planar_robot(), noise=0.01, samples=400)
    unmoved = np.eye(len(world.true_base))[3]
    system = replace(world.system, triangle=world.system.triangle * (1.0 - unmoved))
    precision = replace(_white(system), open_share=unmoved)
    essential = essential_parameters(system, precision)
    assert essential.path[0].parameter == 3
    assert essential.path[0].ratio == 0.0


def test_of_two_that_only_act_together_the_later_leaves_and_the_other_carries_both():
    rng = np.random.default_rng(3)
    W = rng.normal(size=(400, 3))
    W[:, 1] = 2.0 * W[:, 0]
    y = W @ np.array([1.0, 1.0, -2.0]) + 0.1 * rng.normal(size=400)
    Q, R = np.linalg.qr(W)
    system = System(R, Q.T @ y, float(y @ y - (Q.T @ y) @ (Q.T @ y)), 400, np.ones(1))
    together = np.array([0.9, 0.4, 0.0])
    information = R.T @ R
    essential = essential_parameters(system, Inference(information, 0.01 * information, together, np.ones(1)))
    assert essential.kept.tolist() == [0, 2]
    # Nothing was lost: the noise alone is left.
    assert essential.path[-1].cost < 1.2 * 0.01 * 400
