"""Read what SYMORO prints: a geometric table, grouping equations, and the parameters that stay.

Angles and lengths are written there as symbols; every grouping equation is linear in the standard parameters,
so it is evaluated here on unit vectors, which gives a row of coefficients.
"""

import ast
import json
import operator
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from veritorque.core.robot.model import Joint, Link, RobotModel
from veritorque.core.robot.modified_dh import ModifiedDHRow

GOLDEN = Path(__file__).parents[2] / "golden" / "symoro.json"
LEVEL, TILTED = (0.0, 0.0, -9.81), (-5.307, -6.843, -4.609)
COLUMNS = ("antecedent", "gamma", "b", "alpha", "d", "r")
_PLACES = (1, 4, 5, 6, 7, 9)
_BINARY = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Pow: operator.pow,
    ast.Div: operator.truediv,
}


@dataclass(frozen=True, eq=False)
class Table:
    """Hold a robot as SYMORO prints it: rows of `COLUMNS` as text, the base parameters, the equations."""

    rows: tuple[tuple[str, ...], ...]
    tilted: bool
    names: tuple[str, ...]
    equations: tuple[str, ...] = ()

    def robot(self, lengths: Mapping[str, float]) -> RobotModel:
        """Build the robot with numbers for the symbols (m)."""
        parts = []
        for number, row in enumerate(self.rows, start=1):
            antecedent, gamma, b, alpha, d, r = (float(value(text, lengths)) for text in row)
            placement = ModifiedDHRow(alpha=alpha, d=d, r=r, gamma=gamma, b=b).placement()
            parts.append(Link(f"link_{number}", "revolute", int(antecedent), number, *placement))
        joints = tuple(Joint(f"joint_{number}", friction=()) for number in range(1, len(parts) + 1))
        return RobotModel("symoro", tuple(parts), joints, np.array(TILTED if self.tilted else LEVEL))

    def coefficients(self, lengths: Mapping[str, float], standard: tuple[str, ...]) -> dict[str, np.ndarray]:
        """Evaluate every base parameter as a row over the standard parameters."""
        units = np.eye(len(standard))
        known: dict[str, object] = {**lengths, **dict(zip(standard, units, strict=True))}
        known |= {f"{letter}{joint}": 0.0 for letter in "CS" for joint in range(1, 10)}
        for line in self.equations:
            name, text = line.removesuffix(";").split(" = ")
            known[name] = value(text, known)
        return {name: np.asarray(known[name]) for name in self.names}


def value(text: str, known: Mapping[str, object]) -> object:
    """Evaluate a sum of products of numbers, known names and pi."""
    return _evaluated(ast.parse(text, mode="eval").body, {"pi": np.pi, **known})


def _evaluated(node: ast.expr, known: Mapping[str, object]) -> object:
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, ast.Name):
        return known[node.id]
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return -_evaluated(node.operand, known)
    if isinstance(node, ast.BinOp):
        return _BINARY[type(node.op)](_evaluated(node.left, known), _evaluated(node.right, known))
    raise ValueError(ast.dump(node))


def printed(file: Path) -> Table:
    """Read a printed file."""
    text = file.read_text()
    equations = text.split("Equations:\n")[1].split("*=*")[0].splitlines()
    kept = text.split("Grouped inertial parameters")[1].split("Dynamic inertia parameters")[1]
    entries = (entry for row in _table(kept) for entry in row[1:] if entry != "0")
    gravity = [row[-1] for row in (line.split() for line in text.splitlines()) if row[:1] == ["X"]]
    return Table(
        rows=tuple(tuple(row[place] for place in _PLACES) for row in _table(text)),
        tilted=gravity == ["G1"],
        names=tuple(entries),
        equations=tuple(line for line in equations if line and "(th" not in line),
    )


def _table(text: str) -> list[list[str]]:
    """Give the rows of the first table, whose header begins with j, up to the empty line after it."""
    lines = iter(text.splitlines())
    next(line for line in lines if line.startswith("j"))
    rows = []
    for line in lines:
        if not line.strip():
            break
        rows.append(line.split())
    return rows


def golden() -> dict[str, dict]:
    """Read the tables that are kept with the tests."""
    return json.loads(GOLDEN.read_text())["robots"]


def golden_table(entry: Mapping[str, object]) -> Table:
    """Give a kept table the form of a printed one."""
    rows = tuple(tuple(row) for row in entry["rows"])
    return Table(rows, bool(entry["tilted"]), tuple(str(entry["names"]).split()))
