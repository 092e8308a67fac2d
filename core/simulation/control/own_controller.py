"""Give the controller of a log to whoever simulates it: one that recomputes the log's command, or none."""

from ...errors import OptionError
from ...log.model import JointLog
from .controller_check import ACCEPTED, ControllerCheck, check_controller
from .declared import DeclaredController


def controller_of(log: JointLog, declared: DeclaredController | None = None) -> ControllerCheck:
    """Find the controller that recomputes a log's command.

    Parameters
    ----------
    declared
        What is known of it. It is checked like everything that is fitted.

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
    found = check_controller(log, declared)
    if found.accepted:
        return found
    given = dict(found.declared.given())
    if not given:
        raise OptionError(
            "no known controller recomputes the log's command, so that none is simulated",
            evidence={"log": log.name, **_nearest(found), "allowed_percent": 100.0 * ACCEPTED},
            remedy="check that position_ref and command are those of this controller; or simulate by replay",
        )
    other = check_controller(log)
    without = {"log": log.name, "declared": given, **_nearest(found), "allowed_percent": 100.0 * ACCEPTED}
    raise OptionError(
        "the declared controller does not recompute the log's command, so that it is not simulated",
        evidence=without | ({"recognised": _nearest(other)} if other.accepted else {}),
        remedy="leave out of the option controller what is not certain: it is fitted; or simulate by replay",
    )


def _nearest(found: ControllerCheck) -> dict[str, object]:
    """Describe the structure that recomputes the command best."""
    best = found.tried[0]
    return {
        "nearest": best.model.kind,
        "velocity": best.model.velocity,
        "delay_samples": best.model.delay_samples,
        "residual_percent": [round(100.0 * value, 2) for value in best.residual],
    }
