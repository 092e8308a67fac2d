"""Draw cases: a log with something hidden, the robot as its user believes it, and the truth beside it.

A seed decides everything: robot, bodies, motion, noise, effect, joint. The effect's size is solved so that
its strength (see `tests.plant.strength`) is the wanted one. Where a drawn effect cannot reach it (the zero
error of a joint that turns about the vertical changes no torque), another joint is drawn, at last another
robot.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property, reduce
from typing import Any

import numpy as np

from tests.plant.controller import Steering, steer
from tests.plant.effects.effect import Effect, Hidden, Signals, moves_the_robot, overriding
from tests.plant.effects.registry import EFFECTS, FOREIGN, LATER
from tests.plant.engine import Recording, simulate
from tests.plant.excitation import draw_excitation
from tests.plant.robots import ROBOTS, Arm, draw_arm
from tests.plant.sensors import NOISES, record
from tests.plant.strength import Residue, differentiation_error, given, nameable, residue
from veritorque.core.log.model import JointLog
from veritorque.core.robot.model import RobotModel

NOISE_SHARES = (0.01, 0.03)
"""Noise RMS over torque RMS, drawn per joint between these."""
WORLDS, DRAWS, STEPS = 10, 8, 6
"""How many worlds, effects in each, and sizes of each are tried."""


class ImpossibleError(Exception):
    """Say that no world was found in which an effect of the wanted strength can be hidden."""


@dataclass(frozen=True)
class Truth:
    """Say what is hidden.

    Attributes
    ----------
    joints
        The joints it belongs to; a finding of a cause that is not `local` need not name them.
    parameters
        The hidden numbers.
    strength
        RMS of what the standard model cannot absorb over noise RMS, on the joint where it is largest.
    noncentrality
        The oracle's lambda, the other effects' sizes being unknown too.
    nameable
        Whether the oracle's power is at least 0.9 at a level of 1e-3.
    """

    cause: str
    joints: tuple[int, ...]
    parameters: tuple[Hidden, ...]
    strength: float
    noncentrality: float
    nameable: bool
    local: bool


@dataclass(frozen=True, eq=False)
class Case:
    """Hold what the code under test gets (`believed`, `log`) and what it is scored by.

    `attempt` and `effects` say how it was drawn; a case that comes out of the cache does not know.
    """

    believed: RobotModel
    log: JointLog
    truth: tuple[Truth, ...]
    noise: str
    noise_rms: np.ndarray
    robot: str
    seed: int
    attempt: int = 0
    effects: tuple[Effect, ...] = ()


@dataclass(frozen=True, eq=False)
class World:
    """Hold a drawn arm with its motion and noise, before anything is hidden in it."""

    arm: Arm
    steering: Steering
    noise: str
    noise_rms: np.ndarray
    rate_hz: float
    seed: int
    attempt: int = 0
    _last: dict[tuple[Effect, ...], Recording] = field(default_factory=dict)

    @cached_property
    def clean(self) -> Recording:
        """Record the arm where nothing is hidden."""
        return simulate(self.arm, (), self.steering, rate_hz=self.rate_hz)

    def signals(self, effects: tuple[Effect, ...], *, smooth: bool = False) -> Signals:
        """Give what the sensors see under the effects."""
        seen = self._moved(tuple(one for one in effects if moves_the_robot(one)))
        rng = np.random.default_rng([self.seed, 1])
        sensing = overriding(effects, "sense")
        return reduce(lambda signals, one: one.sense(signals, rng), sensing, seen.sampled(smooth=smooth))

    def _moved(self, moving: tuple[Effect, ...]) -> Recording:
        """Record the arm under effects. The last recording is kept: what was measured is logged next."""
        if not moving:
            return self.clean
        if moving not in self._last:
            arm = reduce(lambda whole, one: one.true(whole), moving, self.arm)
            self._last.clear()
            self._last[moving] = simulate(arm, moving, self.steering, rate_hz=self.rate_hz)
        return self._last[moving]

    def believed(self, effects: tuple[Effect, ...]) -> RobotModel:
        """Give the robot as its user describes it."""
        arm = reduce(lambda whole, one: one.true(whole), effects, self.arm)
        return reduce(lambda robot, one: one.believed(robot), effects, arm.robot)

    def residue(self, effect: Effect) -> Residue:
        """Measure one effect alone."""
        robot = self.believed((effect,))
        signals = self.signals((effect,), smooth=not effect.raw)
        torque = signals.torque
        if effect.raw:
            torque = differentiation_error(self.arm, self.clean.sampled(), signals)
            signals = self.clean.sampled(smooth=True)
        return residue(robot, signals, torque, self.noise_rms, self.noise)


def draw(
    seed: int,
    cause: str | None = None,
    strength: float = 1.0,
    *,
    effects: int = 1,
    noise: str | None = None,
    robot: str | None = None,
    rate_hz: float = 250.0,
    duration: float = 30.0,
) -> Case:
    """Draw a case with one or more effects, each of the wanted strength by itself.

    Parameters
    ----------
    seed
        Decides everything that is not given.
    cause
        The (first) hidden cause; any if None.
    strength
        RMS of what the standard model cannot absorb over noise RMS.
    effects
        How many causes are hidden; they differ from each other.
    """
    for attempt in range(WORLDS):
        rng = np.random.default_rng([seed, attempt])
        world = draw_world(rng, seed, noise=noise, robot=robot, rate_hz=rate_hz, duration=duration)
        hidden = _hidden(world, cause, strength, effects, rng)
        if hidden:
            return case_of(replace(world, attempt=attempt), tuple(one for one, _ in hidden), _truth(hidden))
    raise ImpossibleError(f"no {cause or 'effect'} of strength {strength} is possible in case {seed}")


def draw_clean(
    seed: int,
    *,
    noise: str | None = None,
    robot: str | None = None,
    rate_hz: float = 250.0,
    duration: float = 30.0,
) -> Case:
    """Draw a case with nothing hidden."""
    rng = np.random.default_rng([seed, 0])
    return case_of(
        draw_world(rng, seed, noise=noise, robot=robot, rate_hz=rate_hz, duration=duration), (), ()
    )


def draw_foreign(seed: int, strength: float = 1.0, **options: Any) -> Case:
    """Draw a case with an effect that is in no list."""
    name = str(np.random.default_rng([seed, 3]).choice(list(FOREIGN)))
    return draw(seed, name, strength, **options)


def draw_world(
    rng: np.random.Generator,
    seed: int,
    *,
    noise: str | None = None,
    robot: str | None = None,
    rate_hz: float = 250.0,
    duration: float = 30.0,
) -> World:
    """Draw an arm, its motion and its noise."""
    name, kind = str(rng.choice(ROBOTS)), str(rng.choice(NOISES))
    arm = draw_arm(robot or name, rng)
    steering = steer(arm, draw_excitation(arm, rng, duration), rate_hz)
    share = rng.uniform(*NOISE_SHARES, arm.joints)
    noise_rms = share * np.sqrt(np.mean(steering.nominal**2, axis=0))
    return World(arm, steering, noise or kind, noise_rms, rate_hz, seed)


def _hidden(
    world: World, cause: str | None, strength: float, effects: int, rng: np.random.Generator
) -> list[tuple[Effect, Residue]]:
    """Draw effects, a given cause first, until there are enough; give none where there cannot be."""
    first = [name for name in EFFECTS if name not in LATER and name != cause]
    names = [*(str(name) for name in rng.permutation(first)), *(name for name in LATER if name != cause)]
    hidden: list[tuple[Effect, Residue]] = []
    for name in ([cause] if cause else []) + names:
        found = _of_strength(world, name, strength, rng)
        if found is not None:
            hidden.append(found)
        elif name == cause:
            break
        if len(hidden) == effects:
            return hidden
    return []


def _of_strength(
    world: World, cause: str, strength: float, rng: np.random.Generator
) -> tuple[Effect, Residue] | None:
    """Draw effects of a cause until one can be given the wanted strength."""
    for _ in range(DRAWS):
        found = _solved(world, (EFFECTS | FOREIGN)[cause].draw(rng, world.arm, world.steering), strength)
        if found is not None:
            return found
    return None


def _solved(world: World, effect: Effect, strength: float) -> tuple[Effect, Residue] | None:
    """Scale an effect by the secant rule on logarithms until its strength is the wanted one."""
    slope, before = 1.0, None
    for _ in range(STEPS):
        left = world.residue(effect)
        reached = float(left.strength.max())
        if not np.isfinite(reached) or reached < 1e-3 * strength:
            return None
        if abs(reached / strength - 1.0) <= effect.tolerance:
            return effect, left
        if before is not None and abs(np.log(reached / before[0])) > 1e-3:
            slope = float(np.clip(before[1] / np.log(reached / before[0]), 0.3, 3.0))
        step = float(np.clip(slope * np.log(strength / reached), -3.0, 3.0))
        before = (reached, step)
        effect = effect.scaled(float(np.exp(step)))
        if not effect.plausible():
            return None
    return None


def case_of(world: World, effects: tuple[Effect, ...], truth: tuple[Truth, ...]) -> Case:
    """Record a world in which these effects are hidden."""
    rng = np.random.default_rng([world.seed, 2])
    return Case(
        believed=world.believed(effects),
        log=record(world.signals(effects), world.noise_rms, world.noise, rng),
        truth=truth,
        noise=world.noise,
        noise_rms=world.noise_rms,
        robot=world.arm.name,
        seed=world.seed,
        attempt=world.attempt,
        effects=effects,
    )


def truth_of(effect: Effect, strength: float, noncentrality: float) -> Truth:
    """Say what an effect of a measured strength is, and whether the oracle names it."""
    return Truth(
        cause=effect.cause,
        joints=effect.joints,
        parameters=effect.truth(),
        strength=strength,
        noncentrality=noncentrality,
        nameable=nameable(noncentrality),
        local=effect.local,
    )


def _truth(hidden: list[tuple[Effect, Residue]]) -> tuple[Truth, ...]:
    whitened = [left.whitened for _, left in hidden]
    return tuple(
        truth_of(
            effect, float(left.strength.max()), given(left.whitened, whitened[:place] + whitened[place + 1 :])
        )
        for place, (effect, left) in enumerate(hidden)
    )
