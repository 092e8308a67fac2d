"""List the cases: one change each, on measured logs of six robots, with sizes drawn from a seed.

Sizes are those that matter to a user: delays of 8 to 19 ms, a payload of some kilograms, an encoder that is
off by five degrees or a quarter turn, a length that is wrong by a hand's breadth.
"""

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache, partial

import numpy as np

from tests.measured import FRANKA_ROWS, measured_log, measured_robot
from tests.tools import shared
from tests.truths import change
from veritorque.core.log.model import JointLog, whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import RobotModel

PAYLOAD_CENTRE = np.array([0.0, 0.02, 0.08])
"""Centre of an added payload in the last link's frame, m."""
Truth = tuple[str, tuple[int, ...] | None]
"""A conflict or cause by name, and its joints; None where they do not count."""


@dataclass(frozen=True, eq=False)
class Source:
    """Hold a sound robot and its logs; with a reference, the logs that it is made of."""

    name: str
    robot: RobotModel
    logs: tuple[JointLog, ...]
    reference: tuple[JointLog, ...] = ()

    def changed(self, by: Callable[[JointLog], JointLog]) -> "Source":
        """Change every log that is diagnosed."""
        return replace(self, logs=tuple(by(log) for log in self.logs))


@dataclass(frozen=True, eq=False)
class Case:
    """Hold what is asked and what is right."""

    name: str
    sound: Source
    asked: Source
    truths: tuple[Truth, ...]
    """Names that are right; none where what was changed cannot be seen, and nothing may be named."""


@cache
def sources() -> dict[str, Source]:
    """Give the sound robots with the logs that are diagnosed."""
    ur10e, panda, half = measured_robot("ur10e_open"), measured_robot("franka_panda"), FRANKA_ROWS // 2
    thirty = measured_log("ur10e_open", "fourier_30s_12h", 635, 3510)
    first, second = (
        measured_log("franka_panda", "traj1", *rows) for rows in ((0, half), (half, FRANKA_ROWS))
    )
    pendulum = tuple(measured_log("double_pendulum", f"sys_id_{number}") for number in (1, 2, 3))
    listed = (
        Source("ur10e", ur10e, (thirty,)),
        Source("ur10e against", ur10e, (measured_log("ur10e_open", "fourier_20s_8h", 320, 2310),), (thirty,)),
        Source("ur10e standing", ur10e, (measured_log("ur10e_open", "fourier_20s_8h"),)),
        Source("tx40", measured_robot("staubli_tx40"), (measured_log("staubli_tx40", "run1", 500, 37_000),)),
        Source("tx40 standing", measured_robot("staubli_tx40"), (measured_log("staubli_tx40", "run1", 500),)),
        Source("panda", panda, (measured_log("franka_panda", "traj1"),)),
        Source("panda against", panda, (second,), (first,)),
        Source("rokae", measured_robot("rokae_xmate3"), (measured_log("rokae_xmate3", "excit"),)),
        Source("pendulum", pendulum_robot(), pendulum),
        Source("emps", slide_robot(), (slide_log(),)),
        Source("emps slowly", slide_robot(), (thinned(slide_log(), 40),)),
    )
    return {source.name: source for source in listed}


def cases(seed: int) -> Iterator[Case]:
    """Draw the cases of a seed."""
    rng = np.random.default_rng([38, seed])
    known = sources()

    def case(name: str, source: str, asked: Source, *truths: Truth) -> Case:
        return Case(name, known[source], asked, truths)

    for name in ("ur10e", "tx40", "panda", "rokae", "pendulum", "emps"):
        late = float(rng.uniform(0.008, 0.019))
        asked = known[name].changed(partial(change.delayed, seconds=late))
        yield case(f"all torques late by {1e3 * late:.0f} ms", name, asked, ("time_delay", ()))
    yield from _described(known, rng)
    yield from _encoders(known, rng)
    yield from _bodies(known, rng)
    yield from _torques(known, rng)


def _described(known: dict[str, Source], rng: np.random.Generator) -> Iterator[Case]:
    """Describe lengths, gravity and a coupled motor wrongly, where the profile likelihood shows it."""
    for name, joint, entry, by in (("pendulum", 2, "d", -0.1), ("panda", 3, "r", 0.1)):
        asked = replace(known[name], robot=change.with_row(known[name].robot, joint, **{entry: by}))
        yield Case(
            f"{entry} of joint {joint} described {by:+g} m",
            known[name],
            asked,
            (("kinematic_error", (joint,)), ("link_length", (joint,))),
        )
    angle = np.radians(rng.uniform(5.0, 10.0))
    about = np.array([np.cos(turn := rng.uniform(0.0, 6.28)), np.sin(turn), 0.0])
    asked = replace(known["ur10e"], robot=change.tilted(known["ur10e"].robot, angle, about))
    truths = (("gravity_misalignment", ()), ("mounting", ()))
    yield Case(f"base described tilted by {np.degrees(angle):.0f} degrees", known["ur10e"], asked, truths)
    asked = replace(known["tx40"], robot=measured_robot("staubli_tx40", coupled=False))
    yield Case("coupled wrist not described", known["tx40"], asked, (("joint_coupling", (5, 6)),))


def _encoders(known: dict[str, Source], rng: np.random.Generator) -> Iterator[Case]:
    """Turn encoders by a quarter turn or by some degrees."""
    for name, joint in (("panda", 4), ("ur10e", 3), ("rokae", 2)):
        angle = float(rng.choice([-0.5, 0.5])) * np.pi
        asked = known[name].changed(partial(change.turned_encoder, joint=joint, angle=angle))
        yield Case(
            f"encoder {joint} off by {np.degrees(angle):+.0f} degrees",
            known[name],
            asked,
            (("zero_quarter_turn", (joint,)),),
        )
    for name, joint in (("rokae", 4), ("panda", 4)):
        angle = float(rng.choice([-1.0, 1.0]) * np.radians(rng.uniform(4.0, 8.0)))
        asked = known[name].changed(partial(change.turned_encoder, joint=joint, angle=angle))
        yield Case(
            f"encoder {joint} off by {np.degrees(angle):+.1f} degrees",
            known[name],
            asked,
            (("encoder_offset", (joint,)),),
        )


def _bodies(known: dict[str, Source], rng: np.random.Generator) -> Iterator[Case]:
    """Add payloads, and push arms that stand."""
    for name in ("ur10e against", "panda against"):
        source, mass = known[name], float(rng.uniform(1.5, 3.5))
        asked = source.changed(partial(change.loaded, robot=source.robot, mass=mass, centre=PAYLOAD_CENTRE))
        yield Case(f"payload of {mass:.1f} kg", source, asked, (("payload_change", None),))
    for name, span, torque in (("ur10e standing", (24.9, 26.5), 100.0), ("tx40 standing", (7.9, 8.8), 60.0)):
        source = known[name]
        asked = source.changed(partial(change.pushed, robot=source.robot, span=span, torque=torque))
        yield Case(
            f"pushed with {torque:g} N m while it stands", source, asked, (("external_contact", None),)
        )


def _torques(known: dict[str, Source], rng: np.random.Generator) -> Iterator[Case]:
    """Change torques: gains, springs, friction, drift, filters and limits."""
    more = float(rng.uniform(1.15, 1.3))
    wave, warm = float(rng.uniform(2.5, 4.0)), float(rng.uniform(8.0, 12.0))

    def case(name: str, source: str, by: Callable[[JointLog], JointLog], *truths: Truth) -> Case:
        return Case(name, known[source], known[source].changed(by), truths)

    yield case("gain of joint 4", "rokae", lambda log: change.scaled(log, 4, more), ("torque_gain", (4,)))
    yield case(
        "gain of joint 3", "ur10e against", lambda log: change.scaled(log, 3, more), ("torque_gain", (3,))
    )
    yield case("gain of the only joint", "emps", lambda log: change.scaled(log, 1, more))
    spring = (("spring_compensator", (2,)), ("cable_force", (2,)))
    yield case("spring on joint 2", "tx40", lambda log: change.sprung(log, 2, 40.0, 0.3), *spring)
    yield case(
        "ripple on joint 2", "panda", lambda log: change.rippled(log, 2, wave, 17), ("torque_ripple", (2,))
    )
    yield case(
        "more Coulomb friction",
        "ur10e against",
        lambda log: change.rubbing(log, 2, 6.0),
        ("friction_change", (2,)),
    )
    yield case(
        "joint 1 warms up",
        "ur10e",
        lambda log: change.warming(log, 1, 30.0, warm),
        ("friction_temperature", (1,)),
    )
    yield case(
        "zero of torque 4 drifts",
        "rokae",
        lambda log: change.drifting(log, 4, 3.0),
        ("torque_offset_drift", (4,)),
    )
    yield case(
        "torques filtered, 8 ms", "tx40", lambda log: change.filtered(log, 0.008), ("torque_filter_lag", ())
    )
    yield case(
        "torque 2 clipped", "tx40", lambda log: change.clipped(log, 2, 0.6), ("torque_saturation", (2,))
    )
    yield case(
        "spring on the slide, 25 Hz",
        "emps slowly",
        lambda log: change.sprung(log, 1, 300.0, 0.1),
        ("spring_compensator", (1,)),
    )


def pendulum_robot() -> RobotModel:
    """Describe the double pendulum, which hangs."""
    return _from_json("double_pendulum")


def slide_robot() -> RobotModel:
    """Describe the slide of one axis."""
    return _from_json("emps")


def _from_json(name: str) -> RobotModel:
    return robot_from_description(json.loads(shared(f"data/{name}/robot.json").read_text()))


def slide_log() -> JointLog:
    """Read the slide's log."""
    return measured_log("emps", "track")


def thinned(log: JointLog, every: int) -> JointLog:
    """Keep every n-th row."""
    rows = whole_rows(log)
    return log_from_arrays(log.name, rows.time[::every], rows.position[::every], rows.torque[::every])
