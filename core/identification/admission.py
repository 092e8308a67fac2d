"""Refuse at once what a robot and its logs do not allow, from what is known of them before any row is read.

What only the samples can show (no motion, a cut-off below the motion's band) is found while computing.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from ..dynamics.model import DynamicModel
from ..errors import OptionError, VeritorqueError
from ..estimate.constraints import check_links
from ..estimate.methods.method import Estimator
from ..estimate.methods.registry import ESTIMATORS
from ..log.model import JointLog
from ..signals.condition import check_currents
from ..signals.several import check_different
from .options import IdentifyOptions


@dataclass(frozen=True)
class KnownLog:
    """Say what is known of a log that was read once."""

    name: str
    channels: tuple[str, ...]
    rate_hz: float
    duration: float
    """Sampling rate, and last stamp minus first in s."""
    samples: int
    stretches: int = 1
    """Number of rows, and of parts between gaps, at most."""
    sha256: str = ""
    """Hash of the file's bytes."""


def known_log(log: JointLog) -> KnownLog:
    """Give what is known of a log that is open."""
    stretches = len(log.segments)
    return KnownLog(log.name, log.channels, log.rate_hz, log.duration, log.samples, stretches, log.sha256)


def admit(options: IdentifyOptions, model: DynamicModel, logs: Sequence[KnownLog]) -> None:
    """Hold options against the model of the robot and the logs that they are meant for.

    Raises
    ------
    OptionError
        If a cut-off, a held-out log, a bound or the estimator does not fit them.
    LogError
        If a log is given twice, or holds currents and the robot does not say what torque a current gives.
    """
    check_different([log.name for log in logs], [log.sha256 for log in logs])
    if options.reference is None:  # otherwise the reference decides which links the model has
        check_links(options.estimate.bounds, model)
    check_flexible(options.estimate.flexible_joints, model)
    options.validation.chosen(len(logs))
    for log in logs:
        try:
            options.filter.check_log(log.rate_hz, log.duration)
            _check_instants(options, log)
            _check_channels(options.estimate.method, log)
            _check_controller(options, log)
            check_currents(model.robot, log.channels, log.name)
        except VeritorqueError as error:
            error.evidence.setdefault("log", log.name)
            raise


def check_flexible(joints: tuple[int, ...], model: DynamicModel) -> None:
    """Refuse springs at joints that are none, or whose motor the model does not tell from the link.

    Raises
    ------
    OptionError
        If there is no such joint, its motor moves others too, or the model lacks bodies or its rotor.
    """
    faults = {joint: _rigid_because(joint, model) for joint in joints}
    found = {joint: fault for joint, fault in faults.items() if fault}
    joints_of_robot = len(model.robot.joints)
    if found:
        joint, fault = next(iter(found.items()))
        raise OptionError(
            f"joint {joint} cannot be flexible: {fault}",
            evidence={"pointer": "/options/flexible_joints", "joints": list(found), "of": joints_of_robot},
            remedy=f"name joints from 1 to {joints_of_robot} with a motor and a rotor_inertia of their own, "
            "and keep the terms rigid_body and rotor_inertia",
        )


def _rigid_because(joint: int, model: DynamicModel) -> str:
    """Say why a joint cannot be flexible; nothing where it can."""
    robot, names = model.robot, {parameter.name for parameter in model.parameters}
    if joint > len(robot.joints):
        return "the robot has no such joint"
    if joint in {moved for coupling in robot.couplings for moved in coupling.joints}:
        return "its motor moves other joints too"
    if [link.joint for link in robot.links].count(joint) > 1:
        return "it moves more than one link"
    if f"IA{joint}" not in names:
        return "the model has no inertia of its rotor"
    return "" if "M1" in names else "the model has no bodies"


def _check_channels(estimator: Estimator, log: KnownLog) -> None:
    """Refuse an estimator that needs channels which the log does not have."""
    missing = [channel for channel in estimator.needs if channel not in log.channels]
    if missing:
        others = [name for name, other in ESTIMATORS.items() if set(other.needs) <= set(log.channels)]
        raise OptionError(
            f"the estimator {estimator.name} needs channels that the log does not have",
            evidence={"missing": missing, "channels": list(log.channels)},
            remedy=f"log {', '.join(missing)}, or ask for one that does without: {', '.join(others)}",
        )


def _check_controller(options: IdentifyOptions, log: KnownLog) -> None:
    """Refuse to simulate the controller of a log that does not show what it was given and asked for."""
    if not options.estimate.simulates_controllers:
        return
    missing = [name for name in ("position_ref", "torque") if name not in log.channels]
    if not {"command", "torque_ref"} & set(log.channels):
        missing.append("command or torque_ref")
    if missing:
        raise OptionError(
            "the log does not show its controller, which was to be simulated",
            evidence={"missing": missing, "channels": list(log.channels)},
            remedy=f"log {', '.join(missing)}, or simulate by replay",
        )


def _check_instants(options: IdentifyOptions, log: KnownLog) -> None:
    """Refuse a decimation that leaves fewer instants than there are blocks to put them in.

    Every stretch between gaps keeps its first instant, whatever the decimation.
    """
    decimation, blocks = options.filter.decimation, options.validation.blocks
    if decimation is None:
        return
    instants = (log.samples - log.stretches) // decimation + log.stretches
    if instants < blocks:
        raise OptionError(
            "decimation leaves fewer instants of the log than there are blocks",
            evidence={"decimation": decimation, "instants": instants, "blocks": blocks},
            remedy="leave decimation out, keep one sample in fewer, or ask for fewer blocks in validation",
        )
