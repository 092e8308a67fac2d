"""Write URDFs for tests: random trees of every kind of joint, and small documents with one thing wrong."""

import numpy as np

from tests.tools import random_bodies
from veritorque.core.robot.frames import rotation_rpy
from veritorque.core.robot.inertia import mass_properties

KINDS = ("revolute", "continuous", "prismatic", "fixed")


def random_urdf(rng: np.random.Generator, links: int) -> str:
    """Write a tree with skew axes and every kind of joint, mimics included; some links have no body."""
    bodies = random_bodies(rng, links + 1)
    parts = [link("link_0", bodies[0], rng)]
    masters: list[str] = []
    for number in range(1, links + 1):
        kind = "revolute" if number == 1 else str(rng.choice(KINDS))
        mimic = ""
        if kind != "fixed" and masters and rng.random() < 0.25:
            ratio, offset = rng.normal(size=2).tolist()
            mimic = f'<mimic joint="{rng.choice(masters)}" multiplier="{ratio!r}" offset="{offset!r}"/>'
        elif kind != "fixed":
            masters.append(f"joint_{number}")
        parts.append(
            link(f"link_{number}", bodies[number] if number == 1 or rng.random() < 0.8 else None, rng)
        )
        axis = rng.normal(size=3)
        parts.append(
            joint(
                f"joint_{number}",
                kind,
                f"link_{rng.integers(0, number)}",
                f"link_{number}",
                mimic,
                axis=axis,
                rng=rng,
            )
        )
    order = rng.permutation(len(parts))
    return robot("".join(parts[place] for place in order))


def link(name: str, body: np.ndarray | None = None, rng: np.random.Generator | None = None) -> str:
    """Write a link with a body along its frame, its inertial frame turned at random."""
    if body is None:
        return f'<link name="{name}"/>'
    mass, centre, inertia = mass_properties(body)
    rpy = rng.uniform(-3.0, 3.0, 3) if rng is not None else np.zeros(3)
    turn = rotation_rpy(*rpy)
    along = turn.T @ inertia @ turn
    axes = (("xx", 0, 0), ("xy", 0, 1), ("xz", 0, 2), ("yy", 1, 1), ("yz", 1, 2), ("zz", 2, 2))
    table = " ".join(f'i{name}="{float(along[row, column])!r}"' for name, row, column in axes)
    return (
        f'<link name="{name}"><inertial><origin xyz="{words(centre)}" rpy="{words(rpy)}"/>'
        f'<mass value="{mass!r}"/><inertia {table}/></inertial></link>'
    )


def joint(
    name: str,
    kind: str,
    parent: str,
    child: str,
    inside: str = "",
    *,
    axis: np.ndarray | None = None,
    rng: np.random.Generator | None = None,
) -> str:
    """Write a joint at a random place, or at its parent's origin."""
    xyz, rpy = (
        (np.zeros(3), np.zeros(3)) if rng is None else (rng.normal(scale=0.3, size=3), rng.uniform(-3, 3, 3))
    )
    limit = '<limit lower="-2" upper="2" effort="50" velocity="3"/>' if "<limit" not in inside else ""
    direction = "" if axis is None else f'<axis xyz="{words(axis)}"/>'
    return (
        f'<joint name="{name}" type="{kind}"><origin xyz="{words(xyz)}" rpy="{words(rpy)}"/>'
        f'<parent link="{parent}"/><child link="{child}"/>{direction}{limit}{inside}</joint>'
    )


def robot(inside: str) -> str:
    """Wrap elements in a robot."""
    return f'<robot name="made-up">{inside}</robot>'


def words(values: np.ndarray) -> str:
    """Write numbers with all their digits."""
    return " ".join(repr(float(value)) for value in values)
