"""Read what is asked of a joint's model: which joint, which order, by which estimator."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import cast

from ..errors import OptionError
from ..fields import Fields
from .names import ESTIMATORS, ORDER_NAMES, EstimatorName, OrderName

JOINT_OPTIONS: Mapping[str, str] = {
    "joint": "the number of a joint, counted from 1",
    "order": f"one of {', '.join(ORDER_NAMES)}",
    "estimator": f"one of {', '.join(ESTIMATORS)}",
}
MOST_JOINTS = 1000
"""No robot has more."""


@dataclass(frozen=True)
class JointOptions:
    """Hold what is asked."""

    joint: int
    """From 1."""
    order: OrderName = "flexible"
    estimator: EstimatorName = "srivc"


class _OptionFields(Fields):
    """Read options; null stands for the default."""

    error = OptionError
    holds = "value"


def parse_joint_options(options: Mapping[str, object] | None) -> JointOptions:
    """Read options from plain data.

    Raises
    ------
    OptionError
        If an option is not known or not valid, or no joint is named.

    Examples
    --------
    >>> parse_joint_options({"joint": 2, "order": "rigid"})
    JointOptions(joint=2, order='rigid', estimator='srivc')
    """
    fields = _OptionFields(options or {}, "the options object", "/options", JOINT_OPTIONS)
    default = JointOptions(fields.integer("joint", (1, MOST_JOINTS)))
    order = fields.choice("order", ORDER_NAMES) if fields.has("order") else default.order
    estimator = fields.choice("estimator", [*ESTIMATORS]) if fields.has("estimator") else default.estimator
    return JointOptions(default.joint, cast("OrderName", order), cast("EstimatorName", estimator))


def check_joint(joint: int, joints: int) -> None:
    """Refuse a joint that the robot does not have.

    Raises
    ------
    OptionError
        If it does not have it.
    """
    if joint > joints:
        raise OptionError(
            f"the robot has no joint {joint}",
            evidence={"pointer": "/options/joint", "joint": joint, "joints": joints},
            remedy=f"name a joint from 1 to {joints}",
        )


def check_one_log(count: int) -> None:
    """Refuse several logs.

    Raises
    ------
    OptionError
        If there is not exactly one.
    """
    if count != 1:
        raise OptionError(
            "the model of a joint is identified from one log",
            evidence={"pointer": "/logs", "logs": count},
            remedy="give one log, in which the joint moves alone",
        )


def admit_joint(options: JointOptions, joints: int, channels: Sequence[Collection[str]]) -> None:
    """Refuse what cannot succeed, by the robot's number of joints and the channels of every log.

    Raises
    ------
    OptionError
        If there is no such joint, not one log, or clsrivc lacks a channel.
    """
    check_joint(options.joint, joints)
    check_one_log(len(channels))
    if options.estimator != "clsrivc":
        return
    missing = [name for name in ("position_ref", "torque") if name not in channels[0]]
    if not {"command", "torque_ref"} & set(channels[0]):
        missing.append("command or torque_ref")
    if missing:
        raise OptionError(
            "clsrivc simulates the log's controller, which the log does not show",
            evidence={"missing": missing, "channels": sorted(channels[0])},
            remedy=f"log {', '.join(missing)}, or ask for srivc",
        )
