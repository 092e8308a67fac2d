"""Name the columns that well-known recorders write, so that a mapping need not list them.

A profile fills in what a mapping leaves open. Units that a recorder does not fix have to be declared.
`{"profile": "ur-rtde"}` is a whole mapping; with a profile a channel may give unit, scale or offset alone,
and `"joints"` names the joints in the robot's order.
Sources: Universal Robots, RTDE guide, output names; libfranka, `logToCSV`; ROS, sensor_msgs/JointState and
REP 103; LeRobot, dataset format v2 and v3; ABB, application manual of Test Signal Viewer, signal names.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ...errors import LogError
from ..channels import JOINT_CHANNELS, TIME

PROFILE, JOINTS = "profile", "joints"
SHOWN_COLUMNS = 24
_NUMBER_AT_END = re.compile(r"[0-9]{1,4}$")


@dataclass(frozen=True)
class Pattern:
    """Describe a channel's columns: a joint stands in place of `{}`; an empty unit has to be declared."""

    column: str
    unit: str = ""

    def find(self, names: Sequence[str]) -> dict[str, str]:
        """Give the columns that fit, by joint."""
        before, _, after = self.column.partition("{}")
        inner = {name: name[len(before) : len(name) - len(after)] for name in names}
        fits = (name for name in names if name == f"{before}{inner[name]}{after}" and inner[name])
        return {inner[name]: name for name in fits}


@dataclass(frozen=True)
class Profile:
    """Describe what one recorder writes; of several patterns of a channel the first that fits counts."""

    time: tuple[Pattern, ...]
    channels: Mapping[str, tuple[Pattern, ...]] = field(default_factory=dict)


PROFILES: dict[str, Profile] = {
    "generic": Profile(time=()),
    "ur-rtde": Profile(
        time=(Pattern("timestamp", "s"),),
        channels={
            "position": (Pattern("actual_q_{}", "rad"),),
            "velocity": (Pattern("actual_qd_{}", "rad/s"),),
            "current": (Pattern("actual_current_{}", "A"),),
            "position_ref": (Pattern("target_q_{}", "rad"),),
            "velocity_ref": (Pattern("target_qd_{}", "rad/s"),),
            "torque_ref": (Pattern("target_moment_{}", "N m"),),
        },
    ),
    "franka": Profile(
        time=(Pattern("time", "ms"), Pattern("duration", "ms")),
        channels={
            "position": (Pattern("state.q[{}]", "rad"), Pattern("q[{}]", "rad")),
            "velocity": (Pattern("state.dq[{}]", "rad/s"), Pattern("dq[{}]", "rad/s")),
            "torque": (Pattern("state.tau_J[{}]", "N m"), Pattern("tau_J[{}]", "N m")),
            "position_ref": (Pattern("state.q_d[{}]", "rad"), Pattern("q_d[{}]", "rad")),
            "velocity_ref": (Pattern("state.dq_d[{}]", "rad/s"), Pattern("dq_d[{}]", "rad/s")),
            "torque_ref": (Pattern("state.tau_J_d[{}]", "N m"), Pattern("tau_J_d[{}]", "N m")),
        },
    ),
    "ros-jointstate": Profile(
        time=(Pattern("time", "s"), Pattern("stamp_s", "s")),
        channels={
            "position": (Pattern("position.{}", "rad"),),
            "velocity": (Pattern("velocity.{}", "rad/s"),),
            "torque": (Pattern("effort.{}", "N m"),),
        },
    ),
    "lerobot": Profile(
        time=(Pattern("timestamp", "s"),),
        channels={
            "position": (Pattern("observation.state_{}"),),
            "velocity": (Pattern("observation.velocity_{}"),),
            "torque": (Pattern("observation.effort_{}"), Pattern("observation.torque_{}")),
            "current": (Pattern("observation.current_{}"),),
        },
    ),
    "rostopic": Profile(
        time=(Pattern("field.header.stamp", "ns"), Pattern("%time", "ns")),
        channels={
            "position": (Pattern("field.position.{}", "rad"), Pattern("field.position{}", "rad")),
            "velocity": (Pattern("field.velocity.{}", "rad/s"), Pattern("field.velocity{}", "rad/s")),
            "torque": (Pattern("field.effort.{}", "N m"), Pattern("field.effort{}", "N m")),
        },
    ),
    "kuka-fri": Profile(
        time=(Pattern("time", "s"),),
        channels={
            "position": (Pattern("mp{}", "rad"),),
            "torque": (Pattern("mt{}", "N m"),),
            "position_ref": (Pattern("ip{}", "rad"),),
        },
    ),
    "kinova-kortex": Profile(
        time=(Pattern("timestamp"), Pattern("time")),
        channels={
            "position": (Pattern("actuators[{}].position", "deg"), Pattern("actuator_{}_position", "deg")),
            "velocity": (
                Pattern("actuators[{}].velocity", "deg/s"),
                Pattern("actuator_{}_velocity", "deg/s"),
            ),
            "torque": (Pattern("actuators[{}].torque", "N m"), Pattern("actuator_{}_torque", "N m")),
            "current": (
                Pattern("actuators[{}].current_motor", "A"),
                Pattern("actuator_{}_current_motor", "A"),
            ),
        },
    ),
    "abb-egm": Profile(
        time=(Pattern("feedback.time", "us"), Pattern("time")),
        channels={
            "position": (Pattern("feedback.joints[{}]", "deg"), Pattern("feedBack.joints.joints[{}]", "deg")),
            "position_ref": (
                Pattern("planned.joints[{}]", "deg"),
                Pattern("planned.joints.joints[{}]", "deg"),
            ),
        },
    ),
    "abb-test-signal-viewer": Profile(
        time=(Pattern("Time"), Pattern("time")),
        channels={
            "position": (Pattern("resolver_angle_{}"),),
            "velocity": (Pattern("speed_{}"),),
            "torque": (Pattern("torque_ref_{}"),),
        },
    ),
}


def fill_in(document: object, names: Sequence[str]) -> object:
    """Turn a mapping that names a profile into one that names columns; any other is given back as it is.

    Parameters
    ----------
    document
        The decoded JSON object; None is the same as an empty one.
    names
        The columns of the file.

    Raises
    ------
    LogError
        If there is no such profile, or the order of its joints is not known.

    Examples
    --------
    >>> fill_in({"profile": "ur-rtde"}, ["timestamp", "actual_q_0", "actual_q_1"])["position"]
    {'columns': ['actual_q_0', 'actual_q_1'], 'unit': 'rad'}
    """
    if not isinstance(document, Mapping) or PROFILE not in document:
        return document
    filled = dict(document)
    profile, joints = _named_profile(filled.pop(PROFILE)), filled.pop(JOINTS, None)
    if {TIME, "rate_hz"}.isdisjoint(filled):
        filled |= _clock(profile, names)
    for channel in JOINT_CHANNELS:
        found = _columns(profile.channels.get(channel.name, ()), names, joints)
        given = filled.get(channel.name, {})
        if found is not None and isinstance(given, Mapping) and "columns" not in given:
            filled[channel.name] = found | dict(given)
    return filled


def _named_profile(name: object) -> Profile:
    if not isinstance(name, str) or name not in PROFILES:
        raise LogError(
            "there is no such profile",
            evidence={"given": repr(name)[:100], "known": list(PROFILES)},
            remedy="name one of the known profiles, or map the columns",
        )
    return PROFILES[name]


def _clock(profile: Profile, names: Sequence[str]) -> dict[str, object]:
    """Give the mapping of the profile's stamps; empty where the file has none."""
    stamps = (pattern for pattern in profile.time if pattern.column in names)
    return next(({TIME: {"column": stamp.column} | _unit(stamp)} for stamp in stamps), {})


def _unit(pattern: Pattern) -> dict[str, object]:
    return {"unit": pattern.unit} if pattern.unit else {}


def _columns(patterns: Sequence[Pattern], names: Sequence[str], joints: object) -> dict[str, object] | None:
    for pattern in patterns:
        found = pattern.find(names)
        if found:
            order = _order(found, joints)
            return {"columns": [found[joint] for joint in order]} | _unit(pattern)
    return None


def _order(found: Mapping[str, str], joints: object) -> list[str]:
    """Give the joints in the robot's order: as declared, or by number where they differ in nothing else."""
    if joints is None:
        return _order_by_number(found)
    listed = joints if isinstance(joints, list | tuple) else ()
    if not listed or not all(isinstance(joint, str) and joint in found for joint in listed):
        raise LogError(
            "the mapping names joints that the file does not have",
            evidence={"given": repr(joints)[:200], "joints": list(found)[:SHOWN_COLUMNS]},
            remedy="name joints of the file, in the order of the robot",
        )
    return list(listed)


def _order_by_number(found: Mapping[str, str]) -> list[str]:
    if len(found) == 1:
        return list(found)
    if len({_NUMBER_AT_END.sub("", joint) for joint in found}) == 1:
        return sorted(found, key=lambda joint: int(_NUMBER_AT_END.findall(joint)[0]))
    raise LogError(
        "the order of the joints is not known from their names",
        evidence={"joints": list(found)[:SHOWN_COLUMNS]},
        remedy='list them in the order of the robot: "joints": [...] in the mapping',
    )
