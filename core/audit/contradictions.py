"""Find the entries of described bodies that logs contradict: the fewest whose correction explains the log.

What the log tells of the bodies is what remains of the base parameters once friction, offsets and rotors are
projected out, in units of its deviation. The description is granted a slack. The entries are chosen stepwise
(entry, exit, swap) by chi-square of the rest plus what each entry has to gain. Sources: Wald, Trans. Amer.
Math. Soc. 54, 1943 (test of restrictions); Gautier & Khalil 1990 (what is identifiable).
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np
from scipy.linalg import null_space, solve_triangular

from ..arrays import EquationRows, LinkTable, Matrix, Vector
from ..estimate.constraints import link_columns
from ..identification.reference import bodies_spread, with_least_deviation
from ..identification.result import Identification
from ..numerics.distributions import chi2_critical, chi2_tail
from ..robot.inertia import from_mass_properties, mass_properties
from .entries import SIZES, Bodies, Entry
from .thresholds import LOG

ROUNDS = 4
"""Gauss-Newton steps of a fit: only products of mass and centre are not linear."""
IMPOSSIBLE = 1e12
"""Cost of bodies without mass."""
Chosen = frozenset[Entry]


@dataclass(frozen=True, eq=False)
class Evidence:
    """Hold what logs tell of bodies: rows A and values b with b - A p of unit variance, p all parameters."""

    rows: EquationRows
    values: Vector
    bodies: Bodies

    @cached_property
    def entries(self) -> tuple[Entry, ...]:
        """List the entries that the rows depend on."""
        found = []
        for link in range(1, len(self.bodies.table) + 1):
            for kind in SIZES:
                numbers = self.bodies.numbers([Entry(link, kind)])
                slopes = self.rows @ self.bodies.slopes(numbers, np.zeros(len(numbers)))
                if np.abs(slopes).max(initial=0.0) > 0.0:
                    found.append(Entry(link, kind))
        return tuple(found)

    def price(self, entry: Entry) -> float:
        """Give the chi-square that an entry has to gain."""
        return chi2_critical(LOG.p_value / max(len(self.entries), 1), SIZES[entry.kind])


@dataclass(frozen=True, eq=False)
class Correction:
    """Hold the correction of some entries."""

    chosen: Chosen
    table: LinkTable
    """All bodies, the chosen entries corrected."""
    misfit: float
    """Chi-square of what remains."""


@dataclass(frozen=True, eq=False)
class Contradiction:
    """State that logs contradict an entry."""

    entry: Entry
    gain: float
    """By how much its correction lowers the chi-square."""
    p_value: float
    """Corrected for the number of entries."""
    alternatives: tuple[Entry, ...]
    """Entries that explain the logs as well in its place."""


def evidence_of(found: Identification) -> Evidence | None:
    """Give what an identification tells of the described bodies; None where there are none."""
    table, links = found.base.model.robot.prior, link_columns(found.base.model)
    if table is None or not links:
        return None
    columns = [column for link in links for column in link]
    others = [column for column in range(len(found.base.model.parameters)) if column not in set(columns)]
    measured = found.estimate.unconstrained
    root = with_least_deviation(found.precision.root, measured)
    grouping = found.base.grouping
    kept = null_space((root @ grouping[:, others]).T) if others else np.eye(len(root))
    rows, values = kept.T @ root @ grouping[:, columns], kept.T @ root @ measured
    spread = bodies_spread(rows, table, LOG.slack)
    lower = np.linalg.cholesky(np.eye(len(rows)) + spread @ spread.T)
    white = solve_triangular(lower, np.column_stack([rows, values]), lower=True)
    return Evidence(white[:, :-1], white[:, -1], Bodies(table))


def contradictions(evidence: Evidence) -> tuple[tuple[Contradiction, ...], Correction]:
    """Find the contradicted entries, and their correction."""

    @cache
    def corrected(chosen: Chosen) -> Correction:
        return correct(evidence, chosen)

    def cost(chosen: Chosen) -> float:
        return corrected(chosen).misfit + sum(map(evidence.price, chosen))

    chosen = _cheapest(evidence, cost)
    found = []
    for entry in sorted(chosen):
        without = corrected(chosen - {entry}).misfit - corrected(chosen).misfit
        tail = chi2_tail(without, SIZES[entry.kind])
        others = tuple(
            other
            for other in evidence.entries
            if other not in chosen and cost(chosen - {entry} | {other}) < cost(chosen) + LOG.undecided
        )
        found.append(Contradiction(entry, without, min(1.0, tail * len(evidence.entries)), others))
    correction = corrected(chosen)
    return tuple(found), replace(correction, table=_consistent(correction))


def _cheapest(evidence: Evidence, cost: Callable[[Chosen], float]) -> Chosen:
    """Choose stepwise the entries whose correction costs least."""
    chosen: Chosen = frozenset()
    while True:
        best = min(_neighbours(evidence, chosen), key=cost, default=chosen)
        if cost(best) >= cost(chosen) - 1e-6:
            return chosen
        chosen = best


def _neighbours(evidence: Evidence, chosen: Chosen) -> Iterable[Chosen]:
    """Give the choices one step away: an entry or a whole link more, one entry less, one exchanged."""
    for entry in evidence.entries:
        if entry not in chosen:
            yield chosen | {entry}
            yield from (chosen - {other} | {entry} for other in chosen)
    for link in {entry.link for entry in evidence.entries}:
        yield chosen | {entry for entry in evidence.entries if entry.link == link}
    yield from (chosen - {entry} for entry in chosen)


def correct(evidence: Evidence, chosen: Chosen) -> Correction:
    """Fit the numbers of some entries; what the log leaves open stays near the description."""
    bodies = evidence.bodies
    numbers = bodies.numbers(sorted(chosen))
    scale = np.array([bodies.scale[number] for number in numbers])
    change = np.zeros(len(numbers))
    for _ in range(ROUNDS if numbers else 0):
        rest = evidence.values - evidence.rows @ bodies.changed(numbers, change).ravel()
        slopes = evidence.rows @ bodies.slopes(numbers, change) * scale
        change = change + scale * _step(slopes, rest, change / scale)
    table = bodies.changed(numbers, change)
    rest = evidence.values - evidence.rows @ table.ravel()
    misfit = float(rest @ rest) + float(np.sum((change / np.where(scale > 0.0, scale, 1.0)) ** 2))
    possible = all(table[link, 9] > 0.0 for link, _ in numbers)
    return Correction(chosen, table, misfit if possible else IMPOSSIBLE)


def _step(slopes: Matrix, rest: Vector, at: Vector) -> Vector:
    """Give the step of least squares with a unit prior about the description."""
    stacked = np.vstack([slopes, np.eye(len(at))])
    return np.asarray(np.linalg.lstsq(stacked, np.concatenate([rest, -at]), rcond=None)[0])


def _consistent(correction: Correction) -> LinkTable:
    """Give the bodies, those that were corrected brought to ones that can be: mass and centre stay."""
    table = correction.table.copy()
    for link in {entry.link - 1 for entry in correction.chosen}:
        mass, centre, inertia = mass_properties(table[link])
        moments, axes = np.linalg.eigh(0.5 * np.trace(inertia) * np.eye(3) - inertia)
        least = LOG.thinnest * max(float(moments[-1]), 0.0)
        if moments[0] < least:
            second = axes * np.maximum(moments, least) @ axes.T
            table[link] = from_mass_properties(mass, centre, np.trace(second) * np.eye(3) - second)
    return table


def described_mass(table: LinkTable) -> float:
    """Give the mass of all bodies, kg."""
    return float(sum(mass_properties(body)[0] for body in table))
