"""List every torque term: the standard model's, the cure of every cause, the patterns without one."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from core.diagnosis.catalogue import AGAINST_REFERENCE
from core.diagnosis.unlisted import Unlisted
from core.dynamics.model import STANDARD_TERMS
from core.dynamics.term import Term
from core.dynamics.terms.trace import Trace
from tests.core.diagnosis.scenes import eventful_scene

FOLDER = Path(__file__).parents[3] / "core" / "dynamics" / "terms"
SHARED_PARTS = {"__init__", "effect", "own_joint", "rounding"}
FILES = sorted({path.stem for path in FOLDER.glob("*.py")} - SHARED_PARTS)
SEARCHED = sorted(set(FILES) - set(STANDARD_TERMS))


def file_of(term: Term) -> str:
    return type(term).__module__.rsplit(".", 1)[-1]


@cache
def cures() -> tuple[Term, ...]:
    """Give the term of every cause at one site, and once more with the joints' temperatures logged."""
    scene = eventful_scene()
    warm = replace(scene.look.state, temperature=np.full_like(scene.look.state.position, 30.0))
    looks = (scene.look, replace(scene.look, state=warm))
    return tuple(
        cause.term(look, scene.believed, site, cause.grid(look, scene.believed, site)[0])
        for look in looks
        for cause in AGAINST_REFERENCE
        for site in [cause.sites(look, scene.believed)[-1]]
    )


@cache
def traces() -> tuple[Term, ...]:
    """Give every pattern that has no cause, each with the first numbers that a search would try."""
    scene, suspect = eventful_scene(), Unlisted()
    site = suspect.sites(scene.look, scene.believed)[-1]
    grid = suspect.grid(scene.look, scene.believed, site)
    terms = [suspect.term(scene.look, scene.believed, site, one) for one in reversed(grid)]
    return tuple({term.pattern: term for term in terms if isinstance(term, Trace)}.values())


def searched(file: str) -> tuple[Term, ...]:
    """Give the terms of a file that a search makes, by what they share with no other."""
    return tuple(one for one in (*cures(), *traces()) if file_of(one) == file)
