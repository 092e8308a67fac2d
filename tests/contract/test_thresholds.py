"""Keep every number that decides what is named where numbers are kept, with its meaning and source."""

import ast
import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2] / "core"
THRESHOLDS = sorted([*ROOT.glob("*/thresholds.py"), *ROOT.glob("diagnosis/thresholds/[a-z]*.py")])
ROOMS = ("audit", "conflicts", "diagnosis", "extension")
MODULES = sorted(path for room in ROOMS for path in (ROOT / room).rglob("*.py") if path not in THRESHOLDS)

NAMED = {
    "grid": {
        "conflicts/kinds/mounting": "_COARSE _USUAL _REFINEMENT",
        "conflicts/kinds/zero_offset": "_QUARTER",
        "conflicts/kinds/zero_quarter_turn": "_DEGREES",
        "diagnosis/causes/backlash": "NARROWEST WIDEST STEPS",
        "diagnosis/causes/cable_force": "SHARES",
        "diagnosis/causes/friction_position_dependent": "MOST",
        "diagnosis/causes/friction_presliding": "NARROWEST WIDEST STEPS",
        "diagnosis/causes/friction_stribeck": "SLOWEST QUICKEST STEPS",
        "diagnosis/causes/friction_temperature": "SHARES",
        "diagnosis/causes/friction_viscous_nonlinear": "EXPONENTS",
        "diagnosis/causes/joint_elasticity": "LOWEST HIGHEST POINTS DAMPING_RATIOS",
        "diagnosis/causes/payload_change": "INSTANTS",
        "diagnosis/causes/shared/harmonics": "DISTINCT",
        "diagnosis/causes/shared/own_joint": "MOTOR_SHARES",
        "diagnosis/causes/time_delay": "STARTS",
        "diagnosis/causes/torque_filter_lag": "STARTS",
        "diagnosis/causes/position_filter": "ORDERS GAINS LOWEST HIGHEST STARTS",
        "diagnosis/causes/torque_offset_drift": "SHARES",
        "diagnosis/causes/torque_ripple": "MOST BAND_SHARE",
        "diagnosis/causes/torque_saturation": "SHARES",
        "diagnosis/checks/change_points": "SMOOTHED FAR",
        "diagnosis/checks/structure_left": "VARIANCES",
        "diagnosis/checks/unnamed_pattern": "WAVES SLOWEST QUICKEST STEP FINER SWINGS LOOPS SWITCHES",
        "diagnosis/search/alignment": "PARTS",
        "diagnosis/search/profile_likelihood": "AROUND FINER",
    },
    "numerics": {
        "audit/contradictions": "ROUNDS IMPOSSIBLE",
        "audit/description": "ROUNDING",
        "audit/entries": "SIZES _AT _PAIRS",
        "conflicts/kinds/channels_swapped": "_PAIR",
        "conflicts/kinds/link_length": "_GENERAL",
        "conflicts/reduced": "RIDGE _REWEIGHTINGS",
        "conflicts/trial": "_GENERAL _STEP",
        "extension/cure": "_WIDE",
        "extension/gain": "SEED",
        "diagnosis/bandwidth": "_POINTS",
        "diagnosis/causes/backlash": "SMOOTHING_OVER_BAND",
        "diagnosis/causes/shared/events": "FIRST_STEP HALVINGS _NOTHING _RIDGE ROUNDING",
        "diagnosis/causes/torque_filter_lag": "ORDER PERIODS",
        "diagnosis/checks/gain": "SEED",
        "diagnosis/checks/instruments": "RANK_TOLERANCE",
        "diagnosis/checks/kurtosis": "NORMAL",
        "diagnosis/checks/structure_left": "STEEP",
        "diagnosis/regression/gls": "RIDGE STEPS EXACT",
        "diagnosis/regression/innovation_covariance": "MIDDLE",
        "diagnosis/regression/nuisance": "LEAST EARLIER RIDGE",
        "diagnosis/regression/prewhitening": "ROUNDING",
        "diagnosis/residual/floor": "WINDOW_SECONDS _BELOW_NYQUIST _POINTS",
        "diagnosis/residual/memory": "_LONGEST",
        "diagnosis/residual/period": "NEWTON_STEPS _TAPS _TAPS_OF_A_LOG _LONGEST_LAG _WHOLE _KAISER",
        "diagnosis/search/profile_likelihood": "RELATIVE_STEP LEAST_STEP WIDENINGS YIELDINGS SAME_SIZE",
    },
    "units": {"audit/description": "UNITS", "conflicts/kinds/unit": "_PREFIXES _ANGLES _STROKES"},
    "effort": {
        "diagnosis/bandwidth": "_SAMPLES",
        "diagnosis/causes/dropped_samples": "ROWS",
        "diagnosis/checks/clipped_channel": "ROWS",
        "diagnosis/checks/gain": "DRAWS",
        "diagnosis/dataset/columns": "BATCH",
        "extension/gain": "DRAWS",
    },
    "figure": {
        "diagnosis/causes/exclusion": "EXCLUSIONS",
        "diagnosis/causes/link_parameters": "LISTED",
        "diagnosis/checks/figure": "BINS EXPLAINED",
        "diagnosis/residual/atlas": "BINS FEWEST_IN_BIN _RIDGE",
        "diagnosis/residual/learner": "_PLACES",
    },
}
"""Constants of modules that decide nothing, by the reason why.

A grid discretises what is refined afterwards; numerics are tolerances, orders and constants of mathematics;
units are factors between units; effort only costs time or memory; a figure only shows and decides nothing.
"""
UNNAMED = {
    "audit/contradictions": {"3": "a body has three axes"},
    "audit/description": {"3": "a point has three coordinates"},
    "audit/entries": {
        "3": "a mass centre has three coordinates",
        "4": "numbers of a body before its inertia",
        "6": "an inertia has six numbers",
        "10": "a body has ten numbers",
        "0.001": "a body of a gram",
        "0.0001": "a body of a centimetre",
    },
    "conflicts/time_base": {"3": "sums per joint", "65536": "rows read at once"},
    "conflicts/trial": {"3": "gravity has three components", "9.81": "standard gravity"},
    "diagnosis/causes/dropped_samples": {"0.01": "per cent"},
    "diagnosis/causes/external_contact": {"3": "a force has three components"},
    "diagnosis/causes/torque_gain_nonlinear": {"3.0": "root of a cubic", "1.5": "root of a cubic"},
    "diagnosis/causes/shared/bodies": {"10": "a body has ten parameters"},
    "diagnosis/checks/bursts": {"10.0": "decimal logarithm"},
    "diagnosis/checks/confidence": {"4": "digits in a file"},
    "diagnosis/checks/findings": {"10.0": "decimal logarithm"},
    "diagnosis/checks/kurtosis": {
        "10.0": "decimal logarithm",
        "3.0": "fourth central moment",
        "4.0": "fourth central moment",
        "5": "powers 0 to 4",
        "6.0": "fourth central moment",
    },
    "diagnosis/checks/lagging_reference": {"10.0": "decimal logarithm"},
    "diagnosis/checks/position_noise": {"10.0": "decimal logarithm"},
    "diagnosis/diagnose": {"0.1": "progress", "10.0": "decimal logarithm"},
    "diagnosis/causes/timestamp_jitter": {"2": "joints are compared in pairs"},
    "diagnosis/residual/atlas": {"2": "one bin has no curve"},
    "diagnosis/residual/learner": {"0.5": "a sum of zeros and ones is not zero"},
}
"""Numbers within functions that decide nothing, with the reason why."""
PLAIN = {0, 1, 2, 0.5, 100, 1000}
"""Numbers of formulae and units; where something is compared, clipped or a default, only the first two."""
GUARD = 1e-6
"""Smaller ones keep a quotient finite."""
TEXT = {"number_text", "tell", "lru_cache"}
"""Functions whose numbers are digits of a text, shares of the progress, or a memory's size."""
SOURCED = re.compile(r"[Ss]et by hand|set on|Source|[Cc]ounted|law|smallest number|[A-Z]\w+ & [A-Z]\w+")


def number(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and type(node.value) in (int, float)


def named(module: ast.Module) -> set[str]:
    """List the constants of a module that hold numbers."""
    found = set()
    for node in module.body:
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        value = getattr(node, "value", None)
        if isinstance(node, ast.Assign | ast.AnnAssign) and value is not None:
            names = [one.id for target in targets for one in ast.walk(target) if isinstance(one, ast.Name)]
            if all(name.lstrip("_").isupper() for name in names) and any(map(number, ast.walk(value))):
                found |= set(names)
    return found


def unnamed(module: ast.Module) -> set[str]:
    """List the numbers of a module's functions and classes that could decide something."""
    definitions = (ast.FunctionDef, ast.ClassDef)
    return {text for one in module.body if isinstance(one, definitions) for text in deciding(one)}


def deciding(node: ast.AST, *, strict: bool = False) -> Iterator[str]:
    """List the numbers below a node that are not plain; where they decide by themselves, `strict` ones."""
    if number(node):
        plain = {0, 1} if strict else PLAIN
        guards = not strict and isinstance(node.value, float) and node.value <= GUARD
        if node.value not in plain and not guards:
            yield repr(node.value)
        return
    if isinstance(node, ast.JoinedStr | ast.Subscript):
        children = [node.value] if isinstance(node, ast.Subscript) else []
    elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow) and number(node.right):
        children = [node.left] + ([node.right] if isinstance(node.right.value, float) else [])
    elif isinstance(node, ast.Call) and called(node) in TEXT:
        children = [one for one in node.args if not number(one)]
    elif isinstance(node, ast.Compare) and counts(node):
        children = [one for one in (node.left, *node.comparators) if not (number(one) and one.value == 2)]
    else:
        children = list(ast.iter_child_nodes(node))
    alone = isinstance(node, ast.Compare | ast.arguments | ast.AnnAssign) or (
        isinstance(node, ast.Call) and called(node) == "clip"
    )
    for child in children:
        yield from deciding(child, strict=alone and number(child))


def called(node: ast.Call) -> str:
    return node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")


def counts(node: ast.Compare) -> bool:
    """Tell whether a comparison is of a length: less than two are no pair."""
    return any(isinstance(one, ast.Call) and called(one) == "len" for one in (node.left, *node.comparators))


def label(path: Path) -> str:
    return path.relative_to(ROOT).with_suffix("").as_posix()


def fields() -> Iterator[tuple[str, str]]:
    """Give every field of every group, with what is said of it and of its group."""
    for path in THRESHOLDS:
        for group in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(group, ast.ClassDef):
                said = [*group.body[1:], None]
                for node, after in pairwise(said):
                    if isinstance(node, ast.AnnAssign):
                        own = after.value.value if isinstance(after, ast.Expr) else ""
                        yield f"{path.stem}.{group.name}.{node.target.id}", own, ast.get_docstring(group)


@pytest.mark.parametrize("path", MODULES, ids=label)
def test_a_constant_of_a_module_decides_nothing_and_says_why(path):
    reasoned = {name for modules in NAMED.values() for name in modules.get(label(path), "").split()}
    assert named(ast.parse(path.read_text(encoding="utf-8"))) == reasoned


@pytest.mark.parametrize("path", MODULES, ids=label)
def test_no_number_within_a_function_decides(path):
    assert unnamed(ast.parse(path.read_text(encoding="utf-8"))) == set(UNNAMED.get(label(path), {}))


@pytest.mark.parametrize(("name", "own", "group"), list(fields()), ids=lambda one: str(one)[:40])
def test_every_threshold_says_what_it_decides_and_where_it_is_from(name, own, group):
    assert own.strip().endswith("."), name
    assert SOURCED.search(f"{group} {own}"), name


def test_every_threshold_is_used():
    code = "\n".join(path.read_text(encoding="utf-8") for path in ROOT.rglob("*.py"))
    used = set(re.findall(r"\b[A-Z][A-Z0-9_]*\.\w+", code))
    assert [name for name, *_ in fields() if usage(name) not in used] == []


def usage(name: str) -> str:
    """Write a threshold as code writes it: `search.SearchThresholds.level` as `SEARCH_THRESHOLDS.level`."""
    _, group, field = name.split(".")
    return re.sub(r"(?<!^)(?=[A-Z])", "_", group).upper() + "." + field


@pytest.mark.parametrize(
    ("code", "found"),
    [
        ("def f(x):\n    return len(x) < 4", {"4"}),
        ("def f(x):\n    return len(x) // 10", {"10"}),
        ("def f(x):\n    return x > 0.5", {"0.5"}),
        ("def f(x):\n    return 0.85 * x", {"0.85"}),
        ("def f(x):\n    return np.clip(x, 0.5, 3.0)", {"0.5", "3.0"}),
        ("def f(x, level=1e-4):\n    return x < level", {"0.0001"}),
        ("class C:\n    share: float = 0.15", {"0.15"}),
        ("def f(x):\n    return max(x, 1e-300) ** 2 * 0.5 + x[3]", set()),
        ("def f(x):\n    return len(x) < 2", set()),
    ],
)
def test_a_number_that_could_decide_is_found(code, found):
    assert unnamed(ast.parse(code)) == found


@pytest.mark.parametrize("code", ["LEVEL = 1e-4", "A, LEVEL = x, 3", "LEVEL: float = 0.1"])
def test_a_constant_that_holds_a_number_is_found(code):
    assert "LEVEL" in named(ast.parse(code))
