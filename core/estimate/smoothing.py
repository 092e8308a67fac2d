"""Choose how far to smooth the sign of Coulomb friction, from the fitted data alone.

Every joint's own equations are solved once per candidate width and the width with the smallest residual is
taken. All candidates ride along as extra columns in one pass over the data, so the choice costs no further
visit.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BlockKey, Indices, JointVector, Series
from ..dynamics.model import DynamicModel
from ..dynamics.term import Entry, Term
from ..dynamics.terms.coulomb import Coulomb
from ..dynamics.terms.coupling import GearCoupling, coupling_widths
from ..reduction.base import base_model
from ..regressor.columns import ColumnPlan
from ..regressor.factor import Factor
from ..regressor.observe import Observation, observe
from ..robot.model import Parameter, RobotModel
from ..signals.condition import Motion
from ..signals.state import MotionState

SHARES = (0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.4)
"""Candidate widths as shares of a joint's RMS speed, besides the plain sign."""
DIRECTIONAL = ("FC", "FCM")


@dataclass(frozen=True)
class _Candidate(Term):
    """Offer a friction term's direction-dependent columns under another name, to compare several widths."""

    term: Coulomb | GearCoupling
    number: int

    @property
    def name(self) -> str:
        return f"{self.term.name}_candidate_{self.number}"

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        return tuple(
            replace(parameter, symbol=f"{parameter.symbol}~{self.number}~")
            for parameter in self.term.parameters(robot)
        )

    def entries(self, robot: RobotModel) -> tuple[Entry, ...]:
        return tuple(self.term.entries(robot)[index] for index in self._places(robot))

    def series(self, robot: RobotModel, state: MotionState) -> Series:
        return self.term.series(robot, state)[self._places(robot)]

    def _places(self, robot: RobotModel) -> list[int]:
        symbols = [parameter.symbol for parameter in self.term.parameters(robot)]
        return [
            index
            for index, (_, column) in enumerate(self.term.entries(robot))
            if symbols[column] in DIRECTIONAL
        ]


def with_smoothed_friction(
    model: DynamicModel,
    motions: tuple[Motion, ...],
    held_out: frozenset[BlockKey],
    progress: Callable[[float], None],
) -> DynamicModel:
    """Give the model with the widths of its smoothed Coulomb friction chosen from the motion."""
    fitted = {(log, block) for log, motion in enumerate(motions) for block in range(motion.blocks)} - held_out
    speed = np.max([motions[log].recipe.rms_speed for log in sorted({log for log, _ in fitted})], axis=0)
    plan = scan_plan(with_candidates(model, speed), base_model(model).kept)
    observation = observe(plan, motions, held_out=held_out, progress=progress)
    return chosen_widths(observation, model, speed, observation.parts(held_out)[0])


def with_candidates(model: DynamicModel, speed: JointVector) -> DynamicModel:
    """Extend a model by its direction-dependent friction at every candidate width.

    `speed` is the RMS speed per joint.
    """
    joints, extra = len(model.robot.joints), list[Term]()
    for number, share in enumerate(SHARES):
        widths = tuple(float(share * rms) for rms in speed)

        offered: dict[str, Coulomb | GearCoupling] = {
            "coulomb": Coulomb(widths[:joints]),
            "coupling": GearCoupling(coupling_widths(model.robot, widths)),
        }
        extra += [_Candidate(offered[term.name], number) for term in model.terms if term.name in offered]
    return replace(model, terms=(*model.terms, *extra))


def chosen_widths(
    observation: Observation, model: DynamicModel, speed: JointVector, fitted: tuple[int, ...]
) -> DynamicModel:
    """Give the model with, per joint, the width that leaves the smallest residual on the fitted blocks."""
    names = [observation.plan.model.parameters[column].name for column in observation.plan.columns]
    shares = np.zeros(len(model.robot.joints))
    for joint, factor in enumerate(observation.joint_factors(fitted)):
        options = [(0.0, _residual(factor, observation.columns_of[joint], names, None))]
        options += [
            (share, _residual(factor, observation.columns_of[joint], names, number))
            for number, share in enumerate(SHARES)
        ]
        shares[joint] = min(options, key=lambda option: option[1])[0]
    widths = tuple(float(width) for width in shares * speed)
    return with_widths(model, widths)


def with_widths(model: DynamicModel, widths: tuple[float, ...]) -> DynamicModel:
    """Give a model's signs of velocity their widths per joint, rad/s or m/s; none keep plain signs."""
    present = {term.name for term in model.terms}
    if widths and "coulomb" in present:
        model = model.with_term(Coulomb(widths))
    if widths and model.robot.couplings and "coupling" in present:
        model = model.with_term(GearCoupling(coupling_widths(model.robot, widths)))
    return model


def scan_plan(model: DynamicModel, kept: tuple[int, ...]) -> ColumnPlan:
    """Plan for the base columns of the plain model and all candidates."""
    marks = tuple(f"{symbol}~" for symbol in DIRECTIONAL)
    candidates = [
        column for column, parameter in enumerate(model.parameters) if parameter.symbol.startswith(marks)
    ]
    return ColumnPlan(model, (*kept, *candidates))


def _residual(factor: Factor, columns: Indices, names: list[str], number: int | None) -> float:
    """Solve one joint's equations alone, with its plain sign columns or those of one candidate instead."""
    wanted = [index for index, column in enumerate(columns) if _belongs(names[column], number)]
    kept = factor.triangle[:, wanted]
    scale = np.linalg.norm(kept, axis=0)
    scale[scale == 0.0] = 1.0
    values, *_ = np.linalg.lstsq(kept / scale, factor.triangle[:, -1], rcond=1e-9)
    miss = factor.triangle[:, -1] - kept / scale @ values
    return float(miss @ miss)


def _belongs(name: str, number: int | None) -> bool:
    if "~" in name:
        return f"~{number}~" in name
    return number is None or name.rstrip("0123456789") not in DIRECTIONAL
