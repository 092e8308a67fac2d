"""Bodies that cannot be are found without a log, and sound ones pass."""

from dataclasses import replace

import numpy as np
import pytest

from tests.audit.draw import draw
from veritorque.core.audit.description import description_remarks
from veritorque.core.robot.inertia import from_mass_properties, mass_properties


def remarks(change, link=3, seed=4, mass=None):
    """Change mass, centre and inertia of a link of a drawn arm, of all links where none is named."""
    case = draw(seed, errors=0)
    table = case.truth.copy()
    for index in range(len(table)) if link is None else [link - 1]:
        table[index] = from_mass_properties(*change(*mass_properties(table[index])))
    return description_remarks(replace(case.robot, prior=table), mass)


@pytest.mark.parametrize("seed", range(12))
def test_sound_bodies_pass(seed):
    assert remarks(lambda *body: body, seed=seed) == ()


CHANGES = {
    "mass": lambda m, c, i: (0.0, c, i),
    "negative_inertia": lambda m, c, i: (m, c, i - np.diag([2.0 * i[0, 0], 0.0, 0.0])),
    "triangle_inequality": lambda m, c, i: (m, c, np.diag([1.0, 1.0, 3.0]) * np.trace(i) / 5.0),
    "centre_outside": lambda m, c, i: (m, c + np.array([0.0, 2.0, 0.0]), i),
    "inertia_too_large": lambda m, c, i: (m, c, 1e3 * i),
    "inertia_too_small": lambda m, c, i: (m, c, 1e-6 * i),
    "mass_too_large": lambda m, c, i: (1e3 * m, c, 1e3 * i),
}


@pytest.mark.parametrize("check", CHANGES)
def test_a_body_that_cannot_be_is_named(check):
    found = remarks(CHANGES[check])
    assert check in [one.check for one in found]
    assert {one.link for one in found} == {3}
    assert all(one.statement and one.remedy for one in found)


@pytest.mark.parametrize(("factor", "words"), [(1e6, "kg mm2"), (1e-3, "grams"), (1e9, "g mm2")])
def test_a_unit_that_all_bodies_share_is_named(factor, words):
    found = remarks(lambda m, c, i: (m, c, factor * i), link=None)
    assert any(one.check == "unit" and words in one.statement for one in found)


def test_a_link_that_differs_from_its_mirror_image_is_named():
    case = draw(4, errors=0)
    links = [
        replace(link, name=f"{side}_{index // 2}")
        for index, (link, side) in enumerate(zip(case.robot.links, ["left", "right"] * 3, strict=True))
    ]
    mirror = np.diag([1.0, -1.0, 1.0])
    table = case.truth.copy()
    for index in (1, 3, 5):
        mass, centre, inertia = mass_properties(table[index - 1])
        table[index] = from_mass_properties(mass, mirror @ centre, mirror @ inertia @ mirror)
    robot = replace(case.robot, links=tuple(links), prior=table)
    assert [one for one in description_remarks(robot) if one.check == "mirrored"] == []
    mass, centre, inertia = mass_properties(table[2])
    table[2] = from_mass_properties(2.0 * mass, centre, inertia)
    assert [one.entry for one in description_remarks(robot) if one.check == "mirrored"] == ["mass"]


def test_the_makers_mass_bounds_the_links_together():
    total = sum(draw(4, errors=0).truth[:, 9])
    assert remarks(lambda *body: body, mass=1.2 * total) == ()
    for mass in (0.9 * total, 3.0 * total):
        assert [one.check for one in remarks(lambda *body: body, mass=mass)] == ["total_mass"]
