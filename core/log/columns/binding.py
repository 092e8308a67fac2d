"""Bind a channel to its columns: units, and what turns a number into SI."""

from collections.abc import Collection
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...arrays import JointSeries, Series
from ..channels import CHANNELS, TIME, UNITS, Unit
from .linkage import Added, as_linkage, linked, offset_before, one_after_another

ROUNDING = 1e-9
"""Relative error that unit and scale may have from being multiplied and divided."""


@dataclass(frozen=True)
class Binding:
    """Bind a channel to its columns, with their units and what turns each into SI: `gain * value + bias`."""

    name: str
    columns: tuple[str, ...]
    gain: tuple[float, ...]
    bias: tuple[float, ...]
    units: tuple[str, ...] = ()
    added: tuple[Added, ...] = ()
    """What is then added of other joints' values, in SI; empty where nothing is."""

    def convert(self, block: Series) -> JointSeries:
        """Turn the channel's columns (columns by rows) into SI (rows by joints)."""
        values = np.array(
            block.T, order="C"
        )  # a copy: the block belongs to its source, which may give it again
        if any(gain != 1.0 for gain in self.gain):
            values *= np.array(self.gain)
        if any(self.bias):
            values += np.array(self.bias)
        return linked(values, self.added)

    def reassigned(
        self,
        source: tuple[int, ...],
        factor: tuple[float, ...],
        offset: tuple[float, ...],
        added: tuple[Added, ...],
    ) -> "Binding":
        """Give every joint another's values, multiplied by a factor, an offset, and others' values added.

        What the binding adds already is added before.
        """
        whole = one_after_another(self.added or ((),) * len(source), source, factor, added)
        gain, bias = (np.array(own)[list(source)] * factor for own in (self.gain, self.bias))
        return Binding(
            self.name,
            tuple(self.columns[joint] for joint in source),
            tuple(gain.tolist()),
            tuple((bias + offset_before(offset, whole, added)).tolist()),
            tuple(self.units[joint] for joint in source) if self.units else (),
            whole,
        )

    def as_mapping(self, prismatic: Collection[int] = ()) -> dict[str, object]:
        """Write the binding as a mapping says it: columns, unit, and scale, offset and linkage where needed.

        Parameters
        ----------
        prismatic
            Joints, from 1, that are known to be prismatic: angles that were declared for them are lengths.

        Examples
        --------
        >>> Binding("torque", ("m1",), (-0.001,), (0.0,), ("mN m",)).as_mapping()
        {'columns': ['m1'], 'unit': ['mN m'], 'scale': [-1.0]}

        A factor that is another unit's is written as this unit.

        >>> Binding("position", ("q1",), (np.pi / 180.0,), (0.0,), ("rad",)).as_mapping()
        {'columns': ['q1'], 'unit': ['deg']}
        >>> Binding("position", ("q1",), (0.001,), (0.0,), ("rad",)).as_mapping(prismatic=[1])
        {'columns': ['q1'], 'unit': ['mm']}
        """
        if self.name == TIME:
            return dict(zip(("column", "unit"), (*self.columns, *self.units), strict=False))
        units = self._units(prismatic)
        scale = [_rounded(gain / unit.factor) for gain, unit in zip(self.gain, units, strict=True)]
        offset = [bias / unit.factor - unit.offset for bias, unit in zip(self.bias, units, strict=True)]
        mapping: dict[str, object] = {"columns": list(self.columns), "unit": [unit.name for unit in units]}
        if {*scale} != {1.0}:
            mapping["scale"] = scale
        if any(offset):
            mapping["offset"] = offset
        if any(self.added):
            mapping["linkage"] = as_linkage(self.added)
        return mapping

    def _units(self, prismatic: Collection[int]) -> list[Unit]:
        """Give the unit in which every column is written."""
        names = self.units or (next(iter(UNITS[self.name])),) * len(self.columns)
        declared = (
            _declared(self.name, name, prismatic=joint in prismatic) for joint, name in enumerate(names, 1)
        )
        return list(map(partial(_unit_of, self.name), self.gain, declared))


def _declared(channel: str, name: str, *, prismatic: bool) -> Unit:
    """Give a declared unit; of a prismatic joint in SI where only a revolute one has it."""
    unit = UNITS[channel][name]
    if not prismatic or unit.prismatic or _is_affine(unit):
        return unit
    return UNITS[channel][CHANNELS[channel].quantity.prismatic]


def _unit_of(channel: str, gain: float, declared: Unit) -> Unit:
    """Give the unit of which a gain is the factor, but for its sign; else the declared one."""
    if _is_affine(declared) or _is_factor(gain, declared):
        return declared
    for unit in UNITS[channel].values():
        if unit.prismatic == declared.prismatic and not _is_affine(unit) and _is_factor(gain, unit):
            return unit
    return declared


def _is_affine(unit: Unit) -> bool:
    """Tell whether more than a factor leads to SI, or whether a log has to give it."""
    return bool(unit.offset) or unit.needs_scale


def _is_factor(gain: float, unit: Unit) -> bool:
    return bool(np.isclose(abs(gain), unit.factor, rtol=ROUNDING, atol=0.0))


def _rounded(scale: float) -> float:
    """Take a scale that is one but for a rounding error for one."""
    return float(np.rint(scale)) if abs(abs(scale) - 1.0) < ROUNDING else scale
