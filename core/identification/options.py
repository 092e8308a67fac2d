"""Read a study's options from plain data, strictly: what is not known is refused with the list of what is.

The options of several packages are read here; each package keeps its own as a frozen dataclass.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from difflib import get_close_matches

import numpy as np

from ..dynamics.model import STANDARD_TERMS
from ..errors import OptionError
from ..estimate.constraints import Bounds, CentreBox, CentreEllipsoid, LinkSize
from ..estimate.options import EstimateOptions, IterationOptions, KalmanOptions, SimulationOptions
from ..fields import Fields, scalar_meanings
from ..signals.recipe import FilterOptions
from ..simulation.control.declared import LISTS, DeclaredController
from ..validation.holdout import HoldOut

DIAGNOSIS_HOLD_OUT = HoldOut(fraction=0.25, blocks=40)
"""A diagnosis needs many held-out blocks: the interval of a gain is drawn from them."""

APPLY, REPORT = "apply", "report"
BEGINNING = "sdp"
"""Estimator by which robot and logs are held against each other before any other fits them."""


@dataclass(frozen=True)
class BootstrapOptions:
    """Ask for a block bootstrap of the constrained estimate: number of draws (0 for none) and seed."""

    draws: int = 100
    seed: int = 0

    def __post_init__(self) -> None:
        """Refuse what no generator can draw."""
        if not 0 <= self.draws <= 2000 or not 0 <= self.seed < 2**32:
            raise OptionError(
                "the bootstrap options are not valid",
                evidence={"draws": self.draws, "seed": self.seed},
                remedy="ask for 0 to 2000 draws and a seed from 0 to 4294967295",
            )


@dataclass(frozen=True)
class IdentifyOptions:
    """Hold all options of an identification."""

    filter: FilterOptions
    estimate: EstimateOptions
    validation: HoldOut
    bootstrap: BootstrapOptions
    terms: tuple[str, ...] | None = None
    """Names of the torque terms; None for the standard model."""
    smooth_coulomb: bool = False
    """Whether the sign of Coulomb friction is smoothed over widths chosen from the fitted data."""
    conflicts: str = APPLY
    """What is done with a correction under which robot and logs agree: ``apply`` or ``report`` it."""
    essential: bool = False
    """Whether only essential base parameters may explain torque."""
    reference: str | None = None
    """What a diagnosis compares the logs with: a job's name or ``prior``; None to identify everything
    anew."""
    given: Mapping[str, object] = field(default_factory=dict)

    @property
    def least_squares(self) -> "IdentifyOptions":
        """Give the same by the least squares that an iteration begins at; itself where nothing iterates."""
        if not self.estimate.method.iterative:
            return self
        return replace(self, estimate=self.estimate.by(BEGINNING))

    def __post_init__(self) -> None:
        """Refuse what cannot be done with a correction."""
        if self.conflicts not in (APPLY, REPORT):
            raise OptionError(
                "conflicts of robot and log can be applied or reported",
                evidence={"pointer": "/options/conflicts", "given": self.conflicts[:50]},
                remedy=f"ask for {APPLY} (the default) or {REPORT}",
            )


class OptionFields(Fields):
    """Read the fields of an object of options; null stands for the default."""

    error = OptionError
    largest = 1e12
    longest = 200
    holds = "value"


PRIOR_FIELDS = {"pull": "a finite number", "entropy": "a finite number"}
BOUND_FIELDS = {
    "margin": "a finite number",
    "mass": "a list of rows of a link's number, its least and its largest mass in kg",
    "total_mass": "the least and the largest mass of all links together, kg",
    "plausible": "true or false",
    "size": "a list of rows of a link's number, a centre and a radius, m: 5 numbers each",
    "centre_box": "a list of rows of a link's number and two corners, m: 7 numbers each",
    "centre_ellipsoid": "a list of rows of a link's number, a centre and three semi-axes, m: 7 numbers each",
}
VALIDATION_FIELDS = scalar_meanings(HoldOut) | {"logs": "a list of log numbers, counted from 1"}
SIMULATION_FIELDS = {"from": "the name of a source"} | {
    name: meaning for name, meaning in scalar_meanings(SimulationOptions).items() if name != "source"
}
CONTROLLER_FIELDS = scalar_meanings(DeclaredController) | dict.fromkeys(
    LISTS, "a list of one number of at least zero per joint"
)
_SECTIONS = {
    "filter": scalar_meanings(FilterOptions),
    "validation": VALIDATION_FIELDS,
    "bootstrap": scalar_meanings(BootstrapOptions),
    "prior": PRIOR_FIELDS,
    "bounds": BOUND_FIELDS,
    "simulation": SIMULATION_FIELDS,
    "controller": CONTROLLER_FIELDS,
    "iteration": scalar_meanings(IterationOptions),
    "kalman": scalar_meanings(KalmanOptions),
}
_SCALARS = {
    "estimator": "the name of an estimator",
    "solver": "the name of a solver",
    "robust": "true or false",
    "weigh_reversals": "true or false",
    "terms": "null or a list of at least one torque term, each named once",
    "smooth_coulomb": "true or false",
    "essential": "true or false",
    "conflicts": "apply or report",
    "flexible_joints": "a list of joint numbers, counted from 1",
}
_OBJECTS = {name: f"an object with {', '.join(fields)}" for name, fields in _SECTIONS.items()}
OPTION_FIELDS = dict(sorted((_SCALARS | _OBJECTS).items()))
REFERENCE_FIELD = {"reference": 'null, the id of a finished job, or "prior"'}


def parse_options(options: Mapping[str, object] | None) -> IdentifyOptions:
    """Read options from plain data.

    Raises
    ------
    OptionError
        If an option is not known, has the wrong type, or is not valid.

    Examples
    --------
    >>> parse_options({"filter": {"cutoff_hz": 10}}).filter.cutoff_hz
    10.0
    >>> parse_options({"validation": {"fraction": 0.3}}).validation.fraction
    0.3
    """
    return _options(options, OPTION_FIELDS, HoldOut())


def parse_diagnose_options(options: Mapping[str, object] | None) -> IdentifyOptions:
    """Read the options of a diagnosis: an identification's, more and shorter blocks held out, a reference.

    Raises
    ------
    OptionError
        If an option is not known, has the wrong type, or is not valid.

    Examples
    --------
    >>> parse_diagnose_options({}).validation.blocks
    40
    """
    parsed = _options(options, OPTION_FIELDS | REFERENCE_FIELD, DIAGNOSIS_HOLD_OUT)
    if parsed.estimate.method.iterative:
        raise OptionError(
            f"a diagnosis cannot be fitted by {parsed.estimate.estimator}, which simulates the model",
            evidence={"pointer": "/options/estimator", "given": parsed.estimate.estimator},
            remedy="leave the estimator out; causes add terms that are not simulated sample by sample",
        )
    held = parsed.validation
    if not held.logs and not round(held.fraction * held.blocks):
        raise OptionError(
            "a diagnosis needs held-out data, and none would be held out",
            evidence={"fraction": held.fraction, "blocks": held.blocks},
            remedy="leave validation out, or hold out a fraction of at least one block",
        )
    return parsed


def _options(
    options: Mapping[str, object] | None, meanings: Mapping[str, str], hold_out: HoldOut
) -> IdentifyOptions:
    top = OptionFields(options or {}, "the options object", "/options", meanings)
    inner = {name: top.inner(name, fields, f"the option {name}") for name, fields in _SECTIONS.items()}
    prior = {name: inner["prior"].number(name) for name in PRIOR_FIELDS if inner["prior"].has(name)}
    return top.record(
        IdentifyOptions(
            filter=inner["filter"].record(FilterOptions()),
            estimate=top.record(
                EstimateOptions(),
                bounds=_bounds(inner["bounds"]),
                simulation=_simulation(inner["simulation"], inner["controller"]),
                iteration=inner["iteration"].record(IterationOptions()),
                kalman=inner["kalman"].record(KalmanOptions()),
                flexible_joints=top.integers("flexible_joints") if top.has("flexible_joints") else (),
                **prior,
            ),
            validation=_validation(inner["validation"], hold_out),
            bootstrap=inner["bootstrap"].record(BootstrapOptions()),
            terms=_terms(top),
            given=dict(options or {}),
        )
    )


def _bounds(fields: Fields) -> Bounds:
    mass = tuple((int(link), low, high) for link, low, high in _rows_of_links(fields, "mass", 3))
    centres = tuple(
        kind(int(link), (a, b, c), (d, e, f))
        for name, kind in (("centre_box", CentreBox), ("centre_ellipsoid", CentreEllipsoid))
        for link, a, b, c, d, e, f in _rows_of_links(fields, name, 7)
    )
    sizes = tuple(
        LinkSize(int(link), (x, y, z), radius) for link, x, y, z, radius in _rows_of_links(fields, "size", 5)
    )
    total = tuple(fields.numbers("total_mass", 2).tolist()) if fields.has("total_mass") else None
    return fields.record(Bounds(), mass=mass, total_mass=total, centres=centres, sizes=sizes)


def _rows_of_links(fields: Fields, name: str, width: int) -> list[list[float]]:
    """Read rows of a link's number and further numbers."""
    if not fields.has(name):
        return []
    rows = fields.rows(name, width)
    if np.any(rows[:, 0] % 1.0):
        fields.refuse(name, "holds a link number that is not whole")
    listed: list[list[float]] = rows.tolist()
    return listed


def _simulation(fields: Fields, controller: Fields) -> SimulationOptions:
    """Read the section, whose source has a name that Python keeps for itself, and that of the controller."""
    source = fields.text("from") if fields.has("from") else SimulationOptions().source
    return fields.record(SimulationOptions(), source=source, controller=_controller(controller))


def _controller(fields: Fields) -> DeclaredController:
    lists = {
        name: tuple(fields.numbers(name, len(fields.items(name, least=1))).tolist())
        for name in LISTS
        if fields.has(name)
    }
    return fields.record(DeclaredController(), **lists)


def _validation(fields: Fields, default: HoldOut) -> HoldOut:
    logs = fields.integers("logs") if fields.has("logs") else default.logs
    return fields.record(default, logs=logs)


def _terms(fields: Fields) -> tuple[str, ...] | None:
    if not fields.has("terms"):
        return None
    names = fields.items("terms", least=1)
    unknown = [name for name in names if name not in tuple(STANDARD_TERMS)]
    if unknown:
        raise OptionError(
            "a torque term is not known",
            evidence={
                "unknown": [str(name)[:50] for name in unknown[:10]],
                "known": sorted(STANDARD_TERMS),
                "nearest": get_close_matches(str(unknown[0]), STANDARD_TERMS),
            },
            remedy="give a list of known terms",
        )
    if len(set(names)) < len(names):
        fields.refuse("terms", "names a term twice")
    return tuple(map(str, names))
