"""Change entries of bodies: mass, mass centre, and inertia about it, as descriptions give them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import LinkParameters, LinkTable, Matrix, Vector
from ..robot.frames import cross_matrix
from ..robot.inertia import from_mass_properties, mass_properties
from .thresholds import LOG

SIZES = {"mass": 1, "centre": 3, "inertia": 6}
"""Numbers per entry, in the order in which a body's ten numbers are arranged here."""
_AT = {"mass": slice(0, 1), "centre": slice(1, 4), "inertia": slice(4, 10)}
_PAIRS = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))


@dataclass(frozen=True, order=True)
class Entry:
    """Name an entry of a description."""

    link: int
    """Number of the link, from 1."""
    kind: str
    """``mass``, ``centre`` or ``inertia``."""


@dataclass(frozen=True, eq=False)
class Bodies:
    """Hold described bodies as mass (kg), mass centre (m) and inertia about it (kg m2): ten numbers each."""

    table: LinkTable

    @cached_property
    def properties(self) -> Matrix:
        """Give the bodies as descriptions do, one row each."""
        return np.array([_properties(body) for body in self.table])

    @cached_property
    def scale(self) -> Matrix:
        """Give by how much each number may be off beforehand."""
        masses = np.maximum(np.abs(self.properties[:, :1]), 1e-3)
        inertia = np.abs(self.properties[:, [4, 7, 9]]).max(axis=1, initial=0.0)[:, None]
        least = 1e-4 * masses  # a body of a centimetre
        inertias = np.repeat(np.maximum(inertia, least), 6, axis=1)
        centres = np.full((len(masses), 3), LOG.unknown_metres)
        return np.hstack([LOG.unknown_share * masses, centres, LOG.unknown_share * inertias])

    def numbers(self, entries: Sequence[Entry]) -> list[tuple[int, int]]:
        """List link (from 0) and place of every number of some entries."""
        return [(entry.link - 1, place) for entry in entries for place in range(10)[_AT[entry.kind]]]

    def changed(self, numbers: Sequence[tuple[int, int]], change: Vector) -> LinkTable:
        """Give all bodies with some numbers changed, as parameters about the links' frames."""
        properties = self.properties.copy()
        for (link, place), value in zip(numbers, change, strict=True):
            properties[link, place] += value
        table = self.table.copy()
        for link in {link for link, _ in numbers}:
            table[link] = _parameters(properties[link])
        return table

    def slopes(self, numbers: Sequence[tuple[int, int]], change: Vector) -> Matrix:
        """Differentiate all parameters with respect to the numbers, at a change of them."""
        properties = self.properties.copy()
        for (link, place), value in zip(numbers, change, strict=True):
            properties[link, place] += value
        slopes = np.zeros((self.table.size, len(numbers)))
        for column, (link, place) in enumerate(numbers):
            slopes[10 * link : 10 * link + 10, column] = _slope(properties[link], place)
        return slopes


def _properties(body: LinkParameters) -> Vector:
    mass, centre, inertia = mass_properties(body)
    return np.array([mass, *centre, *(inertia[pair] for pair in _PAIRS)])


def _parameters(properties: Vector) -> LinkParameters:
    inertia = np.zeros((3, 3))
    for (row, column), value in zip(_PAIRS, properties[4:], strict=True):
        inertia[row, column] = inertia[column, row] = value
    return from_mass_properties(float(properties[0]), properties[1:4], inertia)


def _slope(properties: Vector, place: int) -> LinkParameters:
    """Differentiate ten parameters with respect to one number: all but the centre enter linearly."""
    mass, centre = float(properties[0]), properties[1:4]
    unit = np.zeros(10)
    if place == 0:
        return from_mass_properties(1.0, centre, np.zeros((3, 3)))
    if place >= 4:
        unit[place - 4] = 1.0
        return unit
    axis = np.eye(3)[place - 1]
    arm, step = cross_matrix(centre), cross_matrix(axis)
    inertia = -mass * (arm @ step + step @ arm)
    return np.array([*(inertia[pair] for pair in _PAIRS), *(mass * axis), 0.0])
