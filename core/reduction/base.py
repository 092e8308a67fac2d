"""Find the base parameters of a robot: the independent columns, and how the others group.

Columns are visited in Khalil's order, link after link from the base outwards and YY, MZ, M last within a
revolute link; a column that the ones before it already span is dropped and its coefficients say how its
parameter groups. This gives SYMORO's names and groupings without symbolic algebra. Sources: Gautier & Khalil
1990; Gautier 1991 (numerical, by QR); Khalil & Dombre (2002), ch. 9.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import BaseParameters, Matrix, Parameters, Rows, Vector
from ..dynamics.model import DynamicModel
from ..dynamics.terms.flexible_joints import FlexibleJoints
from ..regressor.columns import all_columns, dense
from ..robot.model import INERTIAL_SYMBOLS, Parameter, RobotModel
from ..signals.state import MotionState

RANK_TOLERANCE = 1e-10
"""A column is dependent when what lies outside the columns before it is less than this share of the column
and of the combination of those that stands for it. Where these are hardly independent themselves, the
combination is large, and so is its rounding (Higham, Accuracy and Stability of Numerical Algorithms, 2002,
ch. 20). Rounding leaves about 1e-13; twists off by a tenth of a milliradian leave about 1e-4."""
_NOTHING = 1e-12
"""A column is zero when it is smaller than this share of the largest of its unit: it is rounding."""
_SEED = 20221
_REVOLUTE_ORDER = ("XX", "XY", "XZ", "YZ", "ZZ", "MX", "MY", "IA", "YY", "MZ", "M")
_PRISMATIC_ORDER = ("M", "MX", "MY", "MZ", "IA", "XX", "XY", "XZ", "YY", "YZ", "ZZ")


@dataclass(frozen=True, eq=False)
class BaseModel:
    """Hold a model's base parameters."""

    model: DynamicModel
    """The model whose standard parameters are grouped."""
    kept: tuple[int, ...]
    """Positions of the base columns in `model.parameters`, in the order of Khalil's tables."""
    grouping: Matrix
    """Matrix G with base = G standard: identity on the kept columns, grouping coefficients on the others."""
    least_share: float = 1.0
    """The least share of a kept column, and of the combination of those before it that is nearest, that lies
    outside these. What is far below one, though above `RANK_TOLERANCE`, hardly shows in a log."""

    def base_of(self, standard: Parameters) -> BaseParameters:
        """Group standard parameters."""
        return np.asarray(self.grouping @ standard)

    @property
    def rank(self) -> dict[str, float]:
        """Give the relative tolerance that decides the rank, and how near it the weakest column came."""
        return {"relative_tolerance": RANK_TOLERANCE, "least_share_kept": self.least_share}

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Name the base parameters as SYMORO does: an R marks those that others are grouped into."""
        return tuple(
            f"{self.parameter(row).symbol}R{self.parameter(row).number}"
            if len(self.relation(row)) > 1
            else self.parameter(row).name
            for row in range(len(self.kept))
        )

    def parameter(self, row: int) -> Parameter:
        """Give the standard parameter that carries a base parameter."""
        return self.model.parameters[self.kept[row]]

    def relation(self, row: int) -> dict[str, float]:
        """Give a base parameter as coefficients of standard parameters, its own first."""
        own = self.kept[row]
        others = [int(column) for column in np.flatnonzero(self.grouping[row]) if column != own]
        return {
            self.model.parameters[column].name: float(self.grouping[row, column]) for column in (own, *others)
        }

    def in_words(self, row: int) -> str:
        """Write a base parameter as a sum, e.g. ``ZZ1 + IA1 + YY2``."""
        text = ""
        for name, coefficient in self.relation(row).items():
            size = abs(coefficient)
            factor = "" if size == 1.0 else f"{size:.5g} "
            joint = (" - " if coefficient < 0 else " + ") if text else ("-" if coefficient < 0 else "")
            text += f"{joint}{factor}{name}"
        return text

    @cached_property
    def without_effect(self) -> tuple[int, ...]:
        """List the standard parameters that no torque depends on."""
        return tuple(int(column) for column in np.flatnonzero(~self.grouping.any(axis=0)))

    def identifiability(self, column: int) -> str:
        """Tell whether a standard parameter is known ``individually``.

        ``in_combination`` or not at all (``no``).
        """
        rows = np.flatnonzero(self.grouping[:, column])
        if not len(rows):
            return "no"
        alone = len(rows) == 1 and len(self.relation(int(rows[0]))) == 1
        return "individually" if alone else "in_combination"


def base_model(model: DynamicModel) -> BaseModel:
    """Find the base parameters that the structure allows, from many random states.

    The states are drawn with a fixed seed and ignore the joint limits: what is sought holds for every motion.
    """
    order = khalil_order(model)
    matrix = dense(all_columns(model), _random_states(model, len(order)))
    matrix = np.vstack([matrix, np.eye(len(order))[_in_motion(model)]])[:, list(order)]
    units = [model.parameters[column].unit for column in order]
    kept, relation, least = _first_independent(matrix, units)
    grouping = np.zeros((len(kept), len(order)))
    grouping[:, list(order)] = relation
    by_table = sorted(range(len(kept)), key=lambda row: _table_place(model, order[kept[row]]))
    return BaseModel(model, tuple(order[kept[row]] for row in by_table), grouping[by_table], least)


def khalil_order(model: DynamicModel) -> tuple[int, ...]:
    """Order the standard parameters so that the first independent columns are the ones that Khalil keeps."""
    return tuple(sorted(range(len(model.parameters)), key=lambda column: _visit(model, column)))


def _visit(model: DynamicModel, column: int) -> tuple[int, int, int]:
    parameter = model.parameters[column]
    rank = (*INERTIAL_SYMBOLS, "IA")
    if parameter.symbol not in rank:
        return (1, column, 0)
    owner = parameter.number if parameter.symbol != "IA" else _link_of(model.robot, parameter.number)
    kind = model.robot.links[owner - 1].kind
    return (0, owner, (_PRISMATIC_ORDER if kind == "prismatic" else _REVOLUTE_ORDER).index(parameter.symbol))


def _table_place(model: DynamicModel, column: int) -> tuple[int, int, int]:
    symbols = (*INERTIAL_SYMBOLS, "IA", "FV", "FC", "OFF")
    parameter = model.parameters[column]
    rank = symbols.index(parameter.symbol) if parameter.symbol in symbols else len(symbols)
    return (parameter.joint, rank, column)


def _link_of(robot: RobotModel, joint: int) -> int:
    return next(number for number, link in enumerate(robot.links, start=1) if link.joint == joint)


def _in_motion(model: DynamicModel) -> list[int]:
    """List the parameters that show in the motion alone: nothing else can take their place."""
    groups = [(term, len(term.parameters(model.robot))) for term in model.terms]
    marks = [term.shapes_motion for term, count in groups for _ in range(count)]
    return [column for column, mark in enumerate(marks) if mark]


def flexible_joints(model: DynamicModel) -> list[int]:
    """List the joints (from 0) with a spring between motor and link."""
    terms = [term for term in model.terms if isinstance(term, FlexibleJoints)]
    return [joint - 1 for term in terms for joint in term.flexible]


def _random_states(model: DynamicModel, parameters: int) -> MotionState:
    """Draw states; motors of flexible joints move otherwise than their links."""
    rng, joints = np.random.default_rng(_SEED), len(model.robot.joints)
    shape = (max(60, 4 * parameters // joints), joints)
    motors = MotionState(*(rng.uniform(-np.pi, np.pi, shape) for _ in range(3)))
    flexible = flexible_joints(model)
    if not flexible:
        return motors
    position, velocity, acceleration = (
        series.copy() for series in (motors.position, motors.velocity, motors.acceleration)
    )
    for series in (position, velocity, acceleration):
        series[:, flexible] = rng.uniform(-np.pi, np.pi, (shape[0], len(flexible)))
    return replace(motors, link_position=position, link_velocity=velocity, link_acceleration=acceleration)


def _first_independent(matrix: Matrix, units: list[str]) -> tuple[list[int], Rows, float]:
    """Pick the columns that the ones before them do not span.

    Give their indices, all columns as combinations of them, and the least share by which a picked one is new.
    """
    scale = np.linalg.norm(matrix, axis=0)
    used = scale > _NOTHING * _largest_of_unit(scale, units)
    scaled = matrix / np.where(used, scale, 1.0)
    basis = np.zeros((len(matrix), 0))
    combined = np.zeros((len(scale), len(scale)))  # the basis as combinations of the columns that were kept
    kept: list[int] = []
    least = 1.0
    for column in np.flatnonzero(used):
        rest = scaled[:, column]
        for _ in range(2):
            rest = rest - basis @ (basis.T @ rest)
        size, count = float(np.linalg.norm(rest)), len(kept)
        stands_for_it = combined[:count, :count] @ (basis.T @ scaled[:, column])
        share = size / float(np.hypot(1.0, np.linalg.norm(stands_for_it)))
        if share > RANK_TOLERANCE:
            basis = np.column_stack([basis, rest / size])
            combined[: count + 1, count] = np.append(-stands_for_it, 1.0) / size
            kept.append(int(column))
            least = min(least, share)
    coordinates = np.linalg.solve(basis.T @ scaled[:, kept], basis.T @ scaled)
    relation = coordinates * np.where(used, scale, 0.0) / scale[kept][:, None]
    return kept, _round_relation(relation), least


def _largest_of_unit(scale: Vector, units: list[str]) -> Vector:
    """Give, per column, the largest norm among the columns of its unit: others cannot be compared with it."""
    largest = {
        unit: max(size for size, own in zip(scale, units, strict=True) if own == unit) for unit in units
    }
    return np.array([largest[unit] for unit in units])


def _round_relation(relation: Matrix) -> Matrix:
    """Remove the rounding from coefficients.

    Anything below 1e-9 is none, anything within 1e-9 of a whole number is it.
    """
    whole = np.round(relation)
    return np.where(np.abs(relation - whole) < 1e-9, whole, relation)
