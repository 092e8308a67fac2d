"""Say what acts on a joint sample by sample: measured, and in a simulation under the log's own controller.

Where friction holds the measured joint, it takes up all that acts: torque and loads count as zero there. A
simulation knows which share of its level friction takes.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from ..arrays import Samples, SquareMatrix, Vector
from ..errors import OptionError, SolverError
from ..robot.model import RobotModel
from ..signals.state import MotionState
from ..simulation.control.control_law import ControlLaw
from ..simulation.control.control_law import Inputs as References
from ..simulation.control.controller_check import ControllerCheck
from ..simulation.control.own_controller import controller_of
from .orders import COULOMB, GRAVITY, OFFSET, TIME_UNIT, Quantity
from .record import JointRecord
from .responses import filtered, sampled
from .task import Model, Signals


def loads_of(record: JointRecord) -> tuple[Quantity, ...]:
    """Name what acts on a joint beside the torque."""
    return (COULOMB, OFFSET, *(GRAVITY if record.gravity else ()))


def measured_signals(record: JointRecord) -> Signals:
    """Give what acted on the joint by the log."""
    return _signals(record, record.torque, record.direction, record.position, ~record.standing)


def signals_of_link(record: JointRecord, model: Model, before: Signals) -> Signals:
    """Give what acted on the joint, with gravity at the position of the link behind its spring.

    The spring gives way by delta, with Jl s^2 (q - delta) + g = (d s + k) delta. Taken at the motor, gravity
    of g per rad would bring errors of g / k into the link's inertia.

    Parameters
    ----------
    before
        Signals with gravity near enough, such as at the motor.
    """
    _, link, stiffness, damping, _ = model.order.physical(model.coefficients)
    step = record.step / TIME_UNIT
    poles = np.array([1.0, TIME_UNIT * damping / link, TIME_UNIT**2 * stiffness / link])
    gravity = before.loads[:, before.on_link] @ model.loads[before.on_link]
    moved = filtered(np.array([1.0, 0.0, 0.0]), poles, record.position - record.position[0], step, "first")
    bent = filtered(np.array([TIME_UNIT**2 / link]), poles, gravity - gravity[0], step, "first")
    position = record.position - moved - bent - gravity[0] / stiffness
    return _signals(record, record.torque, record.direction, position, ~record.standing)


def _signals(
    record: JointRecord, torque: Samples, direction: Samples, position: Samples, moving: np.ndarray
) -> Signals:
    gravity = [np.sin(position), np.cos(position)] if record.gravity else []
    loads = np.column_stack([direction, np.ones(len(torque)), *gravity])
    on_link = np.array([False, False, *(True for _ in gravity)])
    return Signals(torque * moving, loads * moving[:, None], on_link)


@dataclass(frozen=True, eq=False)
class ClosedLoop:
    """Simulate the joint under the log's controller, which is given the references of the log."""

    record: JointRecord
    check: ControllerCheck
    law: ControlLaw
    references: References

    def play(self, model: Model) -> tuple[Samples, Signals]:
        """Give position and what acts, of a model.

        Raises
        ------
        SolverError
            If the motion diverges.
        """
        from ..simulation.closed_loop.one_joint import COLUMNS, play_joint  # compiled when it is first needed

        record = self.record
        quantities = model.order.physical(model.coefficients)
        system, gains = _mechanics(quantities)
        transition, held, _ = sampled(system, gains, record.step)
        loads = np.zeros(4)
        loads[: len(model.loads)] = model.loads
        loads[0] = max(loads[0], 0.0)
        references = tuple(np.ascontiguousarray(part) for part in vars(self.references).values())
        state = np.tile([record.position[0], 0.0], len(system) // 2)
        played = np.zeros((len(record.position), COLUMNS))
        failed = play_joint(
            transition,
            np.ascontiguousarray(held.T),
            loads,
            self.law.table,
            references,
            state,
            record.step,
            played,
        )
        if failed >= 0:
            raise SolverError(
                "the simulated joint diverges under the log's controller",
                evidence={"joint": record.joint, "time_s": failed * record.step, "order": model.order.name},
                remedy="check that references and command are those of this controller, or ask for srivc",
            )
        position, torque, share, link = played.T
        return position, _signals(record, torque, share, link, np.ones(len(share), dtype=bool))


def closed_loop(record: JointRecord, robot: RobotModel) -> ClosedLoop:
    """Recognise the log's controller, and give the loop that it closes.

    Raises
    ------
    OptionError
        If the log holds no reference or command, or no known controller recomputes the command.
    """
    from ..simulation.closed_loop.controlled import Controlled  # both import the compiled loop
    from ..simulation.closed_loop.simulated import Piece

    try:
        check = controller_of(record.segment.log)
    except OptionError as error:
        raise OptionError(
            f"clsrivc simulates the log's controller, which is not known: {error.cause}",
            evidence=error.evidence,
            remedy="log position_ref and the command or torque_ref of the controller, or ask for srivc",
        ) from error
    column = [record.joint - 1]
    law = check.model.law(record.step)
    count = len(record.position)
    empty = np.zeros((count, len(robot.joints)))
    piece = Piece(record.segment, record.step, 0, MotionState(empty, empty, empty), empty)
    whole = Controlled(check.model).inputs(piece)
    own = References(whole.feed_forward[:, column], whole.position[:, column], whole.velocity[:, column])
    table = np.ascontiguousarray(law.table[:, column])
    return ClosedLoop(record, check, ControlLaw(table, law.sampled), own)


def _mechanics(quantities: Vector) -> tuple[SquareMatrix, np.ndarray]:
    """Give the system in position and speed of motor and link, and the gains of torques on either."""
    if len(quantities) == 2:
        inertia, viscous = quantities
        system = np.array([[0.0, 1.0], [0.0, -viscous / inertia]])
        return system, np.array([[0.0, 0.0], [1.0 / inertia, 1.0 / inertia]])
    motor, link, stiffness, damping, viscous = quantities
    system = np.array(
        [
            [0.0, 1.0, 0.0, 0.0],
            [-stiffness / motor, -(damping + viscous) / motor, stiffness / motor, damping / motor],
            [0.0, 0.0, 0.0, 1.0],
            [stiffness / link, damping / link, -stiffness / link, -damping / link],
        ]
    )
    return system, block_diag([[0.0], [1.0 / motor]], [[0.0], [1.0 / link]])
