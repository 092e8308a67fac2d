"""Ask about the shipped logs: with the options left alone, with others, and with what has to be refused."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from tests.answers.product import (
    Document,
    IdentifyRequest,
    JointLog,
    builtin_robot,
    diagnose,
    identify,
    log_from_arrays,
    read_log,
    whole_rows,
)

FOLDER = Path(__file__).parents[2] / "examples" / "yumi"
FEW: Document = {"bootstrap": {"draws": 0}}
BOUNDS: Document = {"total_mass": [8.0, 10.0], "mass": [[7, 0.05, 0.5]]}
IDENTIFIED: dict[str, Document] = {
    "defaults": {},
    "ols": {"estimator": "ols"},
    "wls": {"estimator": "wls"},
    "irls": {"estimator": "irls"},
    "smooth-coulomb": {"smooth_coulomb": True},
    "robust": FEW | {"robust": True},
    "essential": FEW | {"essential": True},
    "bounds": FEW | {"bounds": BOUNDS},
    "far-bounds": FEW | {"bounds": {"total_mass": [0.01, 0.02]}},
    "centre-bounds": FEW | {"bounds": {"centre_ellipsoid": [[7, 0.0, 0.0, 0.0, 0.1, 0.1, 0.1]]}},
    "pull": FEW | {"prior": {"pull": 2.0}},
    "cvxpy": FEW | {"solver": "cvxpy"},
    "entropy": FEW | {"solver": "cvxpy", "prior": {"entropy": 1.0}},
    "cutoff": FEW | {"filter": {"cutoff_hz": 10.0}},
    "filter": FEW | {"filter": {"median_order": 1, "position_cutoff_hz": 40.0, "order": 3, "decimation": 5}},
    "terms": FEW | {"terms": ["rigid_body", "viscous", "coulomb"]},
    "no-validation": FEW | {"validation": {"fraction": 0.0}},
    "blocks": {"validation": {"fraction": 0.4, "blocks": 10}, "bootstrap": {"draws": 30, "seed": 5}},
}
DIAGNOSED: dict[str, Document] = {
    "defaults": {},
    "smooth-coulomb": FEW | {"smooth_coulomb": True},
    "wls": FEW | {"estimator": "wls"},
    "cutoff": FEW | {"filter": {"cutoff_hz": 10.0}},
}
REFUSED: dict[str, Document] = {
    "unknown-option": {"filtre": {}},
    "unknown-term": {"terms": ["rigid_body", "magic"]},
    "unknown-estimator": {"estimator": "magic"},
    "wrong-type": {"bootstrap": {"draws": "many"}},
    "entropy-without-cvxpy": {"prior": {"entropy": 1.0}},
    "cutoff-above-the-rate": {"filter": {"cutoff_hz": 1000.0}},
    "contradictory-bounds": {"bounds": {"total_mass": [10.0, 8.0]}},
}


def asks() -> Mapping[str, Callable[[], Document]]:
    """List what is asked, by name."""
    refused_diagnoses: dict[str, Document] = {
        "nothing-held-out": {"validation": {"fraction": 0.0}},
        "reference-not-at-hand": {"reference": "job-1"},
        "reference-without-bodies": {"reference": "prior"},
    }
    return {
        **{f"yumi-identify-{name}": _asked(identify, options) for name, options in IDENTIFIED.items()},
        **{
            f"yumi-diagnose-hidden-{name}": _asked(diagnose, options, "hidden_log")
            for name, options in DIAGNOSED.items()
        },
        "yumi-diagnose-log": _asked(diagnose, {}),
        "yumi-identify-hidden": _asked(identify, {}, "hidden_log"),
        "yumi-identify-both": _asked(identify, FEW, "log", "hidden_log"),
        "yumi-diagnose-both": _asked(diagnose, FEW | {"validation": {"logs": [2]}}, "hidden_log", "log"),
        **{f"refused-{name}": _asked(identify, options) for name, options in REFUSED.items()},
        **{f"refused-{name}": _asked(diagnose, options) for name, options in refused_diagnoses.items()},
        "refused-short-log": _short,
        "refused-other-robot": _other_robot,
        "refused-no-time": _time_stands,
    }


def _asked(
    task: Callable[[Any], Document], options: Document, *names: str, robot: str = "yumi-left"
) -> Callable[[], Document]:
    return partial(_answered, task, options, names or ("log",), robot)


def _answered(
    task: Callable[[Any], Document], options: Document, names: tuple[str, ...], robot: str
) -> Document:
    return task(IdentifyRequest(builtin_robot(robot), tuple(map(_log, names)), options))


def _log(name: str) -> JointLog:
    return read_log(FOLDER / f"{name}.csv")


def _short() -> Document:
    rows = whole_rows(_log("log"))
    log = log_from_arrays("short", rows.time[:40], rows.position[:40], rows.torque[:40])
    return identify(IdentifyRequest(builtin_robot("yumi-left"), (log,)))


def _time_stands() -> Document:
    rows = whole_rows(_log("log"))
    log = log_from_arrays("standing", 0.0 * rows.time, rows.position, rows.torque)
    return identify(IdentifyRequest(builtin_robot("yumi-left"), (log,)))


def _other_robot() -> Document:
    robot = builtin_robot("yumi-left")
    fewer = replace(robot, joints=robot.joints[:-1], links=robot.links[:-1])
    return identify(IdentifyRequest(fewer, (_log("log"),)))
