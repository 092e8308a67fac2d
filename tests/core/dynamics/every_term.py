"""List every torque term: the standard model's, the cure of every cause, the patterns without one."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from tests.core.diagnosis.scenes import eventful_scene
from tests.core.estimate.worlds import true_parameters
from veritorque.core.diagnosis.causes.protocol import Cause, Setting
from veritorque.core.diagnosis.causes.registry import AGAINST_REFERENCE
from veritorque.core.diagnosis.checks.unnamed_pattern import UnnamedPatternCause
from veritorque.core.dynamics.model import STANDARD_TERMS, standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.dynamics.term import Term
from veritorque.core.dynamics.terms.unnamed_pattern import Trace
from veritorque.core.robot.model import RobotModel
from veritorque.core.simulation.inverse import inverse_dynamics

FOLDER = Path(__file__).parents[3] / "core" / "dynamics" / "terms"
SHARED_PARTS = {"__init__", "effect"}
FILES = sorted({path.stem for path in FOLDER.glob("*.py")} - SHARED_PARTS)
IN_MOTION = {"flexible_joints"}
"""Terms that show in the motion of the links alone: no torque is theirs."""
SEARCHED = sorted(set(FILES) - set(STANDARD_TERMS) - IN_MOTION)


def file_of(term: Term) -> str:
    return type(term).__module__.rsplit(".", 1)[-1]


@cache
def cures_by_cause(robot: RobotModel | None = None) -> tuple[tuple[Cause, Term], ...]:
    """Give every cause with its term at one site, without and, where they matter, with temperatures.

    What is scanned stands at the beginning of its grid, after an eighth, in the middle and at the end. The
    bodies are those of the scene's arm, on another robot where one is given.
    """
    scene = eventful_scene()
    own = scene.operating_point
    model = own.model if robot is None else replace(own.model, robot=robot)
    described = Prediction(model, own.standard, inverse_dynamics)
    warm = replace(scene.dataset.state, temperature=np.full_like(scene.dataset.state.position, 30.0))
    looks = (scene.dataset, replace(scene.dataset, state=warm))
    return tuple(
        (cause, cause.term(Setting(look, described, site, scalars)))
        for look in looks
        for cause in AGAINST_REFERENCE
        if look is scene.dataset or cause.id == "friction_temperature"
        for site in [cause.sites(look)[-1]]
        for grid in [cause.grid(Setting(look, own, site))]
        for place in sorted({0, len(grid) // 8, len(grid) // 2, len(grid) - 1})
        for scalars in [grid[place]]
    )


def cures(robot: RobotModel | None = None) -> tuple[Term, ...]:
    """Give the terms of all causes."""
    return tuple(term for _, term in cures_by_cause(robot))


@cache
def traces() -> tuple[Term, ...]:
    """Give every pattern that has no cause, each with the last numbers that a search would try."""
    dataset, suspect = eventful_scene().dataset, UnnamedPatternCause()
    model = standard_model(dataset.robot)  # with friction, which a joint in a loop has
    rubbing, site = Prediction(model, true_parameters(model)), suspect.sites(dataset)[-1]
    switching = suspect.switching(np.array([0.5, 1.5, 2.0]))
    look = Setting(dataset, rubbing, site)
    grid = (*suspect.grid(look), *suspect.loops(look), switching)
    terms = [suspect.term(Setting(dataset, rubbing, site, one)) for one in grid]
    return tuple({term.pattern: term for term in terms if isinstance(term, Trace)}.values())


def searched(file: str, robot: RobotModel | None = None) -> tuple[Term, ...]:
    """Give the terms of a file that a search makes."""
    return tuple(one for one in (*cures(robot), *traces()) if file_of(one) == file)
