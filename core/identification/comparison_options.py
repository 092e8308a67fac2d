"""Read the options of a comparison of estimators: of all of them, without what each would need to compute."""

from collections.abc import Callable, Mapping

from ..errors import OptionError
from ..estimate.methods.auto import AUTO
from ..estimate.methods.kalman import KalmanFilter
from ..estimate.methods.method import PERIODS, Estimator
from ..estimate.methods.registry import ESTIMATORS
from ..estimate.options import FLEXIBLE
from ..fields import shown
from .options import BEGINNING, IdentifyOptions, parse_options

COMPARE = "compare"
"""Option: the names of the estimators."""
ALL = tuple(name for name in ESTIMATORS if name != AUTO)
"""The estimators that are compared unless some are named: a choice among them is none."""
_ACTS: Mapping[str, Callable[[Estimator], bool]] = {
    "bounds": lambda method: method.feasible,
    "prior.entropy": lambda method: method.feasible,
    "robust": lambda method: method.row_weights,
    "simulation": lambda method: method.iterative,
    "simulation.from": lambda method: bool(method.sources),
    "simulation.bandwidth_hz": lambda method: bool(method.sources),
    "controller": lambda method: bool(method.sources),
    "simulation.window_seconds": lambda method: method.iterative and not method.sources,
    "iteration": lambda method: method.iterative,
    "kalman": lambda method: isinstance(method, KalmanFilter),
}
"""Options, of a section too, that do not act on every estimator."""


def read_estimators(options: Mapping[str, object]) -> tuple[str, ...]:
    """Read the names of the estimators that are to be compared; all by default, but for the choice of one.

    Raises
    ------
    OptionError
        If they are no list of at least two known names, each named once, or one estimator is asked for.
    """
    names = options.get(COMPARE)
    if options.get("estimator") is not None:
        raise OptionError(
            "a comparison has no option estimator",
            evidence={"pointer": "/options/estimator", "given": str(options["estimator"])[:50]},
            remedy=f"name the estimators in the option {COMPARE}",
        )
    if names is None:
        return ALL
    listed = [str(name) for name in names] if isinstance(names, list) else []
    if not 2 <= len(set(listed)) == len(listed) or not set(listed) <= set(ESTIMATORS):
        raise OptionError(
            "a comparison takes at least two known estimators, each named once",
            evidence={"pointer": f"/options/{COMPARE}", "given": str(names)[:80], "known": list(ESTIMATORS)},
            remedy='give a list of names, such as ["sdp", "wls"]',
        )
    return tuple(listed)


def read_options(options: Mapping[str, object]) -> IdentifyOptions:
    """Read a comparison's options, of every estimator; gives those by which all of them begin.

    Raises
    ------
    OptionError
        If an option is not valid, or acts on none of the estimators.
    """
    names = read_estimators(options)
    _check_rigid(options)
    for name in names:
        parse_options(options_for(options, name))
    for key, acts in _ACTS.items():
        if not any(acts(ESTIMATORS[name]) for name in names):
            parse_options({"estimator": names[0], **_only(options, key)})
    if _other_periods(options) and not any(PERIODS in ESTIMATORS[name].sources for name in names):
        parse_options({"estimator": names[0], **_only(options, "simulation.from")})
    return parse_options(options_for(options, BEGINNING))


def _check_rigid(options: Mapping[str, object]) -> None:
    """Refuse flexible joints: parameters of two models are no table, and name the job that takes them."""
    if options.get("flexible_joints"):
        raise OptionError(
            "a comparison fits one model by all estimators, and flexible joints make another one",
            evidence={
                "pointer": "/options/flexible_joints",
                "given": shown(options["flexible_joints"]),
                "estimator": FLEXIBLE,
            },
            remedy=f"leave flexible_joints out here; send a job identify with flexible_joints and estimator"
            f" {FLEXIBLE}, and compare the errors on held-out data",
        )


def options_for(options: Mapping[str, object], name: str) -> dict[str, object]:
    """Give a comparison's options for one estimator: without those that have no effect on it."""
    method = ESTIMATORS[name]
    idle = {COMPARE, *(key for key, acts in _ACTS.items() if not acts(method)), *_unusable(options, method)}
    own = {
        key: {inner: part for inner, part in value.items() if f"{key}.{inner}" not in idle}
        if isinstance(value, Mapping)
        else value
        for key, value in options.items()
        if key not in idle
    }
    return own | {"estimator": name}


def _unusable(options: Mapping[str, object], method: Estimator) -> set[str]:
    """Give the source of motion where the estimator cannot use it and others may."""
    return {"simulation.from"} if _other_periods(options) and PERIODS not in method.sources else set()


def _other_periods(options: Mapping[str, object]) -> bool:
    """Tell whether instruments of other periods are asked for, which not every estimator takes."""
    return _only(options, "simulation.from") == {"simulation": {"from": PERIODS}}


def _only(options: Mapping[str, object], key: str) -> dict[str, object]:
    """Give one option alone, or one of a section; nothing where it is not given."""
    section, _, name = key.partition(".")
    value = options.get(section)
    if not name:
        return {section: value}
    return {section: {name: value[name]}} if isinstance(value, Mapping) and name in value else {}
