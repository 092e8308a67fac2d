"""Read a study's options from plain data, strictly: what is not known is refused with the list of what is.

Kept beside `study` because it names the options of several chapters and belongs to none of them.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import starmap
from typing import cast

from ..dynamics.model import STANDARD_TERMS
from ..errors import OptionError
from ..estimate.constraints import Bounds, CentreBox, CentreEllipsoid
from ..estimate.options import PULL, EstimateOptions
from ..signals.recipe import FilterOptions
from ..validation.holdout import HoldOut

DIAGNOSIS_HOLD_OUT = HoldOut(fraction=0.25, blocks=40)
"""A diagnosis wants many held-out blocks: the interval of a gain is drawn from them."""


@dataclass(frozen=True)
class BootstrapOptions:
    """Ask for a block bootstrap of the constrained estimate: number of draws (0 for none) and seed."""

    draws: int = 100
    seed: int = 0


@dataclass(frozen=True)
class IdentifyOptions:
    """Hold all options of an identification.

    Attributes
    ----------
    terms
        Names of the torque terms; None for the standard model.
    smooth_coulomb
        Whether the sign of Coulomb friction is smoothed over widths chosen from the fitted data.
    essential
        Whether only essential base parameters may explain torque.
    reference
        What a diagnosis compares the logs with: a job's name or ``prior``; None to identify everything anew.
    """

    filter: FilterOptions
    estimate: EstimateOptions
    validation: HoldOut
    bootstrap: BootstrapOptions
    terms: tuple[str, ...] | None = None
    smooth_coulomb: bool = False
    essential: bool = False
    reference: str | None = None
    given: Mapping[str, object] = field(default_factory=dict)


def parse_options(options: Mapping[str, object] | None) -> IdentifyOptions:
    """Read options from plain data.

    Raises
    ------
    OptionError
        If an option is not known, has the wrong type, or makes no sense.

    Examples
    --------
    >>> parse_options({"filter": {"cutoff_hz": 10}}).filter.cutoff_hz
    10.0
    >>> parse_options({"validation": {"fraction": 0.3}}).validation.fraction
    0.3
    """
    reader = _Reader("", dict(options or {}))
    parsed = _parsed(reader, options, HoldOut())
    reader.done()
    return parsed


def parse_diagnose_options(options: Mapping[str, object] | None) -> IdentifyOptions:
    """Read the options of a diagnosis: an identification's, more and shorter blocks held out, a reference.

    Raises
    ------
    OptionError
        If an option is not known, has the wrong type, or makes no sense.

    Examples
    --------
    >>> parse_diagnose_options({}).validation.blocks
    40
    """
    reader = _Reader("", dict(options or {}))
    parsed = replace(_parsed(reader, options, DIAGNOSIS_HOLD_OUT), reference=_reference(reader))
    reader.done()
    held = parsed.validation
    if not held.logs and not round(held.fraction * held.blocks):
        raise OptionError(
            "a diagnosis needs data that no fit has seen, and none would be held out",
            evidence={"fraction": held.fraction, "blocks": held.blocks},
            remedy="leave validation out, or hold out a fraction of at least one block",
        )
    return parsed


def _reference(reader: "_Reader") -> str | None:
    named, value = reader.values.get("reference") is not None, reader.text("reference", "")
    if named and not 0 < len(value) <= 200:
        raise reader.wrong("reference", value, 'null, the id of a finished job, or "prior"')
    return value or None


def _parsed(reader: "_Reader", options: Mapping[str, object] | None, hold_out: HoldOut) -> IdentifyOptions:
    return IdentifyOptions(
        filter=_filter(reader.section("filter")),
        estimate=_estimate(reader),
        validation=_validation(reader.section("validation"), hold_out),
        bootstrap=_bootstrap(reader.section("bootstrap")),
        terms=_terms(reader),
        smooth_coulomb=reader.flag("smooth_coulomb", default=False),
        essential=reader.flag("essential", default=False),
        given=dict(options or {}),
    )


class _Reader:
    """Take known entries out of a mapping and refuse the rest."""

    def __init__(self, path: str, values: dict[str, object]) -> None:
        self.path = path
        self.values = values
        self.known: list[str] = []

    def take(self, name: str) -> object:
        self.known.append(name)
        return self.values.pop(name, None)

    def section(self, name: str) -> "_Reader":
        value = self.take(name)
        if value is not None and not isinstance(value, Mapping):
            raise self.wrong(name, value, "an object")
        return _Reader(f"{self.path}/{name}", dict(cast("Mapping[str, object]", value or {})))

    def number(self, name: str, default: float) -> float:
        value = self.optional(name)
        return default if value is None else value

    def optional(self, name: str) -> float | None:
        value = self.take(name)
        if value is None:
            return None
        if not _is_finite(value):
            raise self.wrong(name, value, "a finite number")
        return float(cast("float", value))

    def whole(self, name: str, default: int) -> int:
        value = self.optional_whole(name)
        return default if value is None else value

    def optional_whole(self, name: str) -> int | None:
        value = self.take(name)
        if value is not None and (isinstance(value, bool) or not isinstance(value, int)):
            raise self.wrong(name, value, "a whole number")
        return value

    def flag(self, name: str, *, default: bool) -> bool:
        value = self.take(name)
        if value is not None and not isinstance(value, bool):
            raise self.wrong(name, value, "true or false")
        return default if value is None else value

    def text(self, name: str, default: str) -> str:
        value = self.take(name)
        if value is not None and not isinstance(value, str):
            raise self.wrong(name, value, "a text")
        return default if value is None else value

    def done(self) -> None:
        unknown = [f"{self.path}/{name}".lstrip("/") for name in sorted(self.values)]
        if unknown:
            raise OptionError(
                "an option is not known",
                evidence={"unknown": unknown, "known": sorted(self.known)},
                remedy="use the known options only",
            )

    def wrong(self, name: str, value: object, wanted: str) -> OptionError:
        return OptionError(
            f"the option {self.path}/{name} is not {wanted}".replace("option /", "option "),
            evidence={"pointer": f"/options{self.path}/{name}", "value": repr(value)[:100]},
            remedy=f"give {wanted}",
        )


def _is_finite(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e12


def _filter(reader: _Reader) -> FilterOptions:
    parsed = FilterOptions(
        median_order=reader.whole("median_order", 5),
        cutoff_hz=reader.optional("cutoff_hz"),
        position_cutoff_hz=reader.optional("position_cutoff_hz"),
        order=reader.whole("order", 5),
        decimation=reader.optional_whole("decimation"),
    )
    reader.done()
    return parsed


def _estimate(reader: _Reader) -> EstimateOptions:
    prior = reader.section("prior")
    parsed = EstimateOptions(
        estimator=reader.text("estimator", "sdp"),
        solver=reader.text("solver", "clarabel"),
        robust=reader.flag("robust", default=False),
        pull=prior.number("pull", PULL),
        entropy=prior.number("entropy", 0.0),
        bounds=_bounds(reader.section("bounds")),
    )
    prior.done()
    return parsed


def _bounds(reader: _Reader) -> Bounds:
    mass = tuple((int(link), low, high) for link, low, high in _rows(reader, "mass", 3))
    total = _rows(reader, "total_mass", 0)
    boxes, balls = (
        [(int(k), (a, b, c), (d, e, f)) for k, a, b, c, d, e, f in _rows(reader, name, 7)]
        for name in ("centre_box", "centre_ellipsoid")
    )
    parsed = Bounds(
        mass=mass,
        total_mass=(total[0][0], total[0][1]) if total else None,
        centres=(*starmap(CentreBox, boxes), *starmap(CentreEllipsoid, balls)),
        margin=reader.number("margin", Bounds().margin),
    )
    reader.done()
    return parsed


def _rows(reader: _Reader, name: str, width: int) -> list[list[float]]:
    """Read a list of rows of numbers; width 0 stands for one pair."""
    value = reader.take(name)
    if value is None:
        return []
    rows = [value] if width == 0 else value
    wide = width or 2
    good = isinstance(rows, list) and all(
        isinstance(row, list)
        and len(row) == wide
        and all(_is_finite(one) for one in row)
        and (width == 0 or float(row[0]).is_integer())
        for row in rows
    )
    if not good:
        wanted = f"a list of rows of a link's number and {wide - 1} numbers" if width else "a pair of numbers"
        raise reader.wrong(name, value, f"{wanted}, all finite")
    return [[float(one) for one in row] for row in cast("list[list[float]]", rows)]


def _validation(reader: _Reader, default: HoldOut) -> HoldOut:
    logs = reader.take("logs")
    if logs is not None and not (isinstance(logs, list) and all(type(one) is int for one in logs)):
        raise reader.wrong("logs", logs, "a list of log numbers, counted from 1")
    parsed = HoldOut(
        fraction=reader.number("fraction", default.fraction),
        blocks=reader.whole("blocks", default.blocks),
        logs=tuple(cast("list[int]", logs or [])),
    )
    reader.done()
    return parsed


def _bootstrap(reader: _Reader) -> BootstrapOptions:
    parsed = BootstrapOptions(reader.whole("draws", 100), reader.whole("seed", 0))
    reader.done()
    if not 0 <= parsed.draws <= 2000 or not 0 <= parsed.seed < 2**32:
        raise OptionError(
            "the bootstrap options make no sense",
            evidence={"draws": parsed.draws, "seed": parsed.seed},
            remedy="ask for 0 to 2000 draws and a seed from 0 to 4294967295",
        )
    return parsed


def _terms(reader: _Reader) -> tuple[str, ...] | None:
    value = reader.take("terms")
    if value is None:
        return None
    if value == [] or (isinstance(value, list) and len(set(map(str, value))) < len(value)):
        raise reader.wrong("terms", value, "a list of at least one term, each named once")
    known = tuple(STANDARD_TERMS)
    unknown = [one for one in value if one not in known] if isinstance(value, list) else [value]
    if unknown:
        raise OptionError(
            "a torque term is not known",
            evidence={"unknown": [str(one)[:50] for one in unknown[:10]], "known": sorted(STANDARD_TERMS)},
            remedy="give a list of known terms",
        )
    return tuple(cast("list[str]", value))
