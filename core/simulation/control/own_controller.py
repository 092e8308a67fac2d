"""Give the controller of a log to whoever simulates it: one that recomputes the log's command, or none."""

from ...errors import OptionError
from ...log.model import JointLog
from .controller_check import ACCEPTED, ControllerCheck, check_controller


def controller_of(log: JointLog) -> ControllerCheck:
    """Find the controller that recomputes a log's command.

    Raises
    ------
    OptionError
        If the log holds no reference or command, no torque, or none of the known structures recomputes it.
    """
    if "torque" not in log.channels:
        raise OptionError(
            "the log's controller cannot be simulated: the log holds currents",
            evidence={"channels": list(log.channels), "log": log.name},
            remedy="map the torque, or simulate by replay",
        )
    found = check_controller(log)
    if not found.accepted:
        best = found.tried[0]
        raise OptionError(
            "no known controller recomputes the log's command, so that none is simulated",
            evidence={
                "log": log.name,
                "nearest": best.model.kind,
                "velocity": best.model.velocity,
                "delay_samples": best.model.delay_samples,
                "residual_percent": [round(100.0 * value, 2) for value in best.residual],
                "allowed_percent": 100.0 * ACCEPTED,
            },
            remedy="check that position_ref and command are those of this controller; or simulate by replay",
        )
    return found
