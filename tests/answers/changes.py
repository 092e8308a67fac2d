"""Ask what has changed since an earlier log of the same arm, and against the bodies of its description."""

import json
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from tests.answers.product import Document, IdentifyRequest, JointLog, diagnose, identify
from tests.hidden.plan import Order, drawn
from tests.plant.again import arm_of, logged, with_friction
from tests.plant.effects.drive import TorqueGain
from tests.plant.effects.effect import Effect
from tests.plant.effects.surroundings import PayloadChange

SEED = 1
FEW: Document = {"bootstrap": {"draws": 0}}
BY_JOB: Document = FEW | {"reference": "job-1"}
BY_PRIOR: Document = FEW | {"reference": "prior"}
DRAWN = {"stribeck": "friction_stribeck", "ripple": "torque_ripple", "offset": "encoder_offset"}
"""Drawn cases, by the cause they hide, that are compared with the bodies of a description."""


def asks() -> Mapping[str, Callable[[], Document]]:
    """List what is asked, by name."""
    return {
        "reference-nothing": partial(_since, "planar-3", 101),
        "reference-payload": partial(_since, "planar-3", 102, _load(3)),
        "reference-gain": partial(_since, "planar-3", 103, TorqueGain((2,), 0.05)),
        "reference-friction": partial(_since, "planar-3", 105, rubbed=True),
        "reference-payload-yumi": partial(_since, "yumi-left", 102, _load(7)),
        "reference-smoothed": partial(_since, "planar-3", 101, smooth_coulomb=True),
        "reference-wls": partial(_since, "planar-3", 102, _load(3), estimator="wls"),
        "reference-other-robot": _of_another_robot,
        "reference-decides": _decided,
        "prior-true": partial(_described, 1.0),
        "prior-wrong": partial(_described, 1.3),
        **{f"prior-drawn-{name}": partial(_drawn, cause, 7400) for name, cause in DRAWN.items()},
        "reference-drawn-self": partial(_drawn_since_itself, 7401),
    }


def _load(link: int) -> Effect:
    return PayloadChange((link,), mass=0.3, com_x=0.05, com_y=0.03, com_z=0.0, time=-1.0)


def _earlier(name: str, **options: object) -> Document:
    """Give the result document of an earlier log of an arm, as it comes back from a file."""
    arm = arm_of(name, SEED)
    return _through_json(identify(IdentifyRequest(arm.robot, (logged(arm, 100),), FEW | options)))


def _since(name: str, seed: int, *effects: Effect, rubbed: bool = False, **options: object) -> Document:
    arm = arm_of(name, SEED)
    known = arm.robot
    if rubbed:
        arm = with_friction(arm, 2, viscous=0.13, coulomb=0.4)
    return _compared(known, logged(arm, seed, *effects), _earlier(name, **options))


def _compared(robot: object, log: JointLog, earlier: Document) -> Document:
    return diagnose(IdentifyRequest(robot, (log,), BY_JOB, earlier))


def _of_another_robot() -> Document:
    arm = arm_of("planar-2", SEED)
    return _compared(arm.robot, logged(arm, 101), _earlier("planar-3"))


def _decided() -> Document:
    arm = arm_of("planar-3", SEED)
    options = BY_JOB | {"smooth_coulomb": True}
    return diagnose(IdentifyRequest(arm.robot, (logged(arm, 101),), options, _earlier("planar-3")))


def _described(factor: float) -> Document:
    """Compare with a description whose second link has its first moments scaled."""
    arm = arm_of("planar-3", SEED)
    bodies = arm.bodies.copy()
    bodies[1, 6:9] *= factor
    robot = replace(arm.robot, prior=bodies)
    return diagnose(IdentifyRequest(robot, (logged(arm, 101),), BY_PRIOR))


def _drawn(cause: str, seed: int) -> Document:
    """Compare a drawn case with bodies that an ordinary identification of it gave."""
    order = Order("single", seed, cause, robot="planar-3")
    drawn(order)
    case = drawn(order)
    found = identify(IdentifyRequest(case.believed, (case.log,), FEW))
    values = [one["value"] for one in found["standard_parameters"]][: 10 * len(case.believed.links)]
    robot = replace(case.believed, prior=np.array(values).reshape(-1, 10))
    return diagnose(IdentifyRequest(robot, (case.log,), BY_PRIOR))


def _drawn_since_itself(seed: int) -> Document:
    """Compare a drawn log with what its own identification gave."""
    order = Order("combination", seed, robot="yumi-left", effects=2)
    drawn(order)
    case = drawn(order)
    earlier = _through_json(identify(IdentifyRequest(case.believed, (case.log,), FEW)))
    return _compared(case.believed, case.log, earlier)


def _through_json(document: Document) -> Document:
    given: Document = json.loads(json.dumps(document))
    return given
