"""Two hundred noise draws of two simulations: how often the 95 % intervals hold the true base parameters.

The YuMi of the demonstration, and an arm that sticks at its reversals in another engine.

With the default estimator and without constraints, because constraints may bias and the deviations may be
wrong, and the two look alike in one figure alone.
"""

import numpy as np

from benchmarks.demo_log import demo_robot, noisy_log, truth
from benchmarks.figures import Figure
from tests.plant.cases import draw_world
from tests.plant.sensors import record
from veritorque.core.precision.inference import INTERVAL_95
from veritorque.core.study import IdentifyRequest, identify_in_full

DRAWS = 200
DURATION = 30.0
STICKING = 704
"""Seed of the arm that sticks."""


def run(*, quick: bool) -> list[Figure]:
    """Count over draws and parameters."""
    draws, until = (3, 15.0) if quick else (DRAWS, DURATION)
    figures: list[Figure] = []
    runs = [(name, *standardised_errors(name, draws, until)) for name in ("sdp", "wls")]
    runs.append(("sticking", *sticking_errors(draws, until)))
    for estimator, names, misses in runs:
        held = np.abs(misses) <= INTERVAL_95
        share = 100.0 * held.mean(axis=0)
        low, high = int(np.argmin(share)), int(np.argmax(share))
        bias = np.abs(misses.mean(axis=0))
        worst = int(np.argmax(bias))
        figures += [
            Figure(
                f"{estimator}: true base parameters held, %",
                f"{100.0 * held.mean():.2f}",
                "93..97" if estimator != "wls" and not quick else "",
                f"per parameter {share[low]:.0f} ({names[low]}) to {share[high]:.0f}",
                ratio=True,
            ),
            Figure(
                f"{estimator}: scatter over reported deviation, median",
                f"{np.median(misses.std(axis=0)):.3f}",
                "about 1",
                f"bias over deviation at most {bias[worst]:.2f} ({names[worst]})",
                ratio=True,
            ),
        ]
    return figures


def standardised_errors(estimator: str, draws: int, until: float) -> tuple[tuple[str, ...], np.ndarray]:
    """Give the base parameters' names, and (estimate - truth) / deviation, draws x parameters."""
    robot = demo_robot()
    options = {"estimator": estimator, "bootstrap": {"draws": 0}}
    rows: list[np.ndarray] = []
    names: tuple[str, ...] = ()
    for seed in range(draws):
        found = identify_in_full(IdentifyRequest(robot, (noisy_log(until, seed),), options))
        model = found.base.model
        true = found.base.base_of(np.array([truth()[parameter.name] for parameter in model.parameters]))
        names = found.base.names
        rows.append((found.estimate.base - true) / found.precision.standard_deviation)
    return names, np.array(rows)


def sticking_errors(draws: int, until: float) -> tuple[tuple[str, ...], np.ndarray]:
    """Give the same of an arm whose joints stick at their reversals, by default options."""
    world = draw_world(np.random.default_rng(STICKING), STICKING, robot="planar-2", duration=until)
    arm, signals = world.arm, world.signals(())
    drives = {
        f"{symbol}{joint}": float(value)
        for symbol, values in (
            ("IA", arm.rotor_inertia),
            ("FV", arm.viscous),
            ("FC", arm.coulomb),
            ("OFF", arm.offset),
        )
        for joint, value in enumerate(values, start=1)
    }
    rows: list[np.ndarray] = []
    names: tuple[str, ...] = ()
    for seed in range(draws):
        log = record(signals, world.noise_rms, "white", np.random.default_rng(seed))
        found = identify_in_full(IdentifyRequest(arm.robot, (log,), {"bootstrap": {"draws": 0}}))
        parameters = [parameter.name for parameter in found.base.model.parameters]
        bodies = iter(arm.bodies.ravel())
        standard = [drives[name] if name in drives else float(next(bodies)) for name in parameters]
        names = found.base.names
        true = found.base.base_of(np.array(standard))
        rows.append((found.estimate.base - true) / found.precision.standard_deviation)
    return names, np.array(rows)
