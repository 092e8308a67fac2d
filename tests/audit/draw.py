"""Draw arms, motions, logs with noise, and errors in the arms' descriptions."""

from dataclasses import dataclass, replace

import numpy as np

from tests.core.estimate.worlds import FRICTION, swing
from veritorque.core.arrays import LinkTable
from veritorque.core.audit.entries import Entry
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.inertia import from_mass_properties, mass_properties
from veritorque.core.robot.model import RobotModel

QUARTER = np.pi / 2
ARMS = {
    "elbow": ([0, QUARTER, 0, -QUARTER, QUARTER, -QUARTER], [0, 0, 0.45, 0.05, 0, 0], [0.3, 0, 0, 0.4, 0, 0]),
    "collaborative": (
        [0, QUARTER, 0, 0, QUARTER, -QUARTER],
        [0, 0, 0.6, 0.57, 0, 0],
        [0.18, 0, 0, 0.17, 0.12, 0.11],
    ),
    "seven": (
        [0, -QUARTER, QUARTER, QUARTER, -QUARTER, QUARTER, QUARTER],
        [0, 0, 0, 0.08, -0.08, 0, 0.09],
        [0.33, 0, 0.32, 0, 0.38, 0, 0],
    ),
}
MASSES = {6: [8.0, 13.0, 6.0, 2.5, 2.0, 0.9], 7: [4.0, 4.0, 3.0, 3.5, 2.5, 1.6, 1.0]}
SECONDS, NOISE, LEAST_NOISE = 40.0, 0.01, 0.02


@dataclass(frozen=True, eq=False)
class Drawn:
    """Hold a description with errors, the log of the true arm, and the truth."""

    robot: RobotModel
    log: JointLog
    truth: LinkTable
    spoilt: frozenset[Entry]


def draw(seed: int, *, errors: int | None = None) -> Drawn:
    """Draw a case: one to three links spoilt, or as many as asked."""
    rng = np.random.default_rng(seed)
    name = sorted(ARMS)[seed % len(ARMS)]
    alpha, d, r = ARMS[name]
    rows = [
        {"type": "revolute", "alpha": a, "d": x, "r": z, "theta_offset": 0.0}
        for a, x, z in zip(alpha, d, r, strict=True)
    ]
    robot = robot_from_description({"name": name, "joints": rows})
    truth = np.array([_link(rng, robot, link) for link in range(len(rows))])
    model = standard_model(robot)
    values = np.array([FRICTION.get(one.symbol, 0.0) for one in model.parameters])
    values[: truth.size] = truth.ravel()
    state = swing(len(rows), seed=seed + 7, seconds=SECONDS)
    torque = model.torque(values, state)
    size = NOISE * np.sqrt(np.mean(torque**2, axis=0)) + LEAST_NOISE
    torque += size * rng.normal(size=torque.shape)
    log = log_from_arrays("swing", np.arange(len(torque)) / 100.0, state.position, torque)
    described, spoilt = _spoil(rng, truth, rng.integers(1, 4) if errors is None else errors)
    return Drawn(replace(robot, prior=described), log, truth, frozenset(spoilt))


def _link(rng: np.random.Generator, robot: RobotModel, link: int) -> np.ndarray:
    """Draw a body about as long as its link, lying along it."""
    mass = MASSES[len(robot.links)][link] * rng.uniform(0.7, 1.3)
    end = robot.links[link + 1].translation if link + 1 < len(robot.links) else np.array([0.0, 0.0, 0.08])
    centre = 0.5 * end + rng.normal(scale=0.02, size=3)
    length = np.abs(end) + rng.uniform(0.06, 0.12, 3)
    inertia = (
        mass
        / 12.0
        * np.diag(
            [
                length[1] ** 2 + length[2] ** 2,
                length[0] ** 2 + length[2] ** 2,
                length[0] ** 2 + length[1] ** 2,
            ]
        )
    )
    turn, _ = np.linalg.qr(np.eye(3) + 0.1 * rng.normal(size=(3, 3)))
    return from_mass_properties(mass, centre, turn @ inertia @ turn.T)


def _spoil(rng: np.random.Generator, truth: LinkTable, links: int) -> tuple[LinkTable, set[Entry]]:
    """Spoil one entry of some links: mass or inertia by a factor of 2 to 10, or the centre by 30 mm."""
    table, spoilt = truth.copy(), set()
    for link in rng.choice(len(truth), links, replace=False):
        mass, centre, inertia = mass_properties(truth[link])
        kind = str(rng.choice(["mass", "centre", "inertia"]))
        factor = rng.uniform(2.0, 10.0) ** rng.choice([-1.0, 1.0])
        if kind == "mass":
            mass *= factor
        elif kind == "inertia":
            inertia = inertia * factor
        else:
            step = rng.normal(size=3)
            centre = centre + 0.03 * step / np.linalg.norm(step)
        table[link] = from_mass_properties(mass, centre, inertia)
        spoilt.add(Entry(int(link) + 1, kind))
    return table, spoilt
