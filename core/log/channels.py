"""List the channels of a log in one table: names, units, usual sizes, and whether a log needs them.

Default names are SI by contract. Every other column declares its unit, because a wrong guess would be a wrong
robot. The reference channels are what a controller asked for: by them it is recognised and simulated.
"""

from dataclasses import dataclass
from math import inf, pi
from typing import Final, Literal


@dataclass(frozen=True)
class Unit:
    """Turn a value into SI, `factor * (value + offset)`, and say which sizes are usual in this unit.

    Examples
    --------
    >>> UNITS["temperature"]["K"].offset
    -273.15
    """

    name: str
    usual: tuple[float, float]
    """Smallest and largest usual magnitude of a column in this unit (of time: its median step)."""
    reason: str
    """Why these are usual."""
    factor: float = 1.0
    offset: float = 0.0
    prismatic: bool = False
    """Whether only prismatic joints have it."""
    needs_scale: bool = False
    """Whether the mapping says what one count or one per cent is: in rad, N m or A."""


@dataclass(frozen=True)
class Quantity:
    """Name the SI unit at a revolute and at a prismatic joint, and all units in which logs come."""

    revolute: str
    prismatic: str
    units: tuple[Unit, ...]


TIMES = Quantity(
    "s",
    "s",
    (
        Unit("s", (1e-5, 0.15), "a log is sampled at 10 Hz to 100 kHz"),
        Unit("ms", (0.15, 150.0), "a log is sampled at 10 Hz to 10 kHz", 1e-3),
        Unit("us", (50.0, 1.5e5), "a log is sampled at 10 Hz to 20 kHz", 1e-6),
        Unit("ns", (5e4, 1.5e8), "a log is sampled at 10 Hz to 20 kHz", 1e-9),
    ),
)
POSITIONS = Quantity(
    "rad",
    "m",
    (
        Unit("rad", (0.02, 13.0), "a revolute joint seldom moves more than two turns either way"),
        Unit("deg", (13.0, 1500.0), "a revolute joint moves some hundred degrees", pi / 180),
        Unit("counts", (1000.0, inf), "whole numbers of this size are encoder counts", needs_scale=True),
        Unit("mm", (13.0, 5000.0), "a prismatic joint moves some hundred mm", 1e-3, prismatic=True),
        Unit("m", (0.005, 5.0), "a prismatic joint moves some metres at most", prismatic=True),
    ),
)
VELOCITIES = Quantity(
    "rad/s",
    "m/s",
    (
        Unit("rad/s", (0.01, 12.0), "a revolute joint moves some rad per second"),
        Unit("deg/s", (12.0, 700.0), "a revolute joint moves some hundred degrees per second", pi / 180),
        Unit("rpm", (100.0, 10000.0), "a motor turns some thousand times per minute", pi / 30),
        Unit("m/s", (0.005, 5.0), "a prismatic joint moves some metres per second at most", prismatic=True),
        Unit("mm/s", (12.0, 5000.0), "a prismatic joint moves some hundred mm/s", 1e-3, prismatic=True),
    ),
)
TORQUES = Quantity(
    "N m",
    "N",
    (
        Unit("N m", (0.05, 3000.0), "a revolute joint needs some newton metres"),
        Unit("counts", (100.0, inf), "whole numbers of this size are counts of a drive", needs_scale=True),
        Unit("mN m", (3000.0, 3e6), "a revolute joint needs some thousand millinewton metres", 1e-3),
        Unit("N", (0.5, 10000.0), "a prismatic joint needs some newtons", prismatic=True),
        Unit("%", (1.0, 400.0), "a drive gives some per cent of its rated torque", needs_scale=True),
    ),
)
CURRENTS = Quantity(
    "A",
    "A",
    (
        Unit("A", (0.02, 80.0), "a motor draws some amperes"),
        Unit("mA", (80.0, 80000.0), "a motor draws some thousand milliamperes", 1e-3),
        Unit("%", (1.0, 400.0), "a drive gives some per cent of its rated current", needs_scale=True),
        Unit("counts", (100.0, inf), "whole numbers of this size are counts of a drive", needs_scale=True),
    ),
)
TEMPERATURES = Quantity(
    "degC",
    "degC",
    (
        Unit("degC", (-20.0, 150.0), "a joint is between frost and 150 degrees Celsius"),
        Unit("K", (250.0, 430.0), "a joint is some 300 kelvin warm", 1.0, -273.15),
    ),
)
COMMANDS = Quantity(
    "1",
    "1",
    (
        Unit("1", (0.0, inf), "a command is a number on the scale of its drive"),
        Unit("V", (0.01, 500.0), "a drive takes a command of some volts"),
        Unit("%", (1.0, 300.0), "a command is some per cent of the drive's rated value", 0.01),
    ),
)


@dataclass(frozen=True)
class Channel:
    """Describe one channel."""

    name: str
    prefix: str
    """Default column names are the prefix, an underscore and the joint's number from 1; of time the
    prefix."""
    quantity: Quantity
    about: str
    """What it is."""
    need: Literal["always", "effort", "optional", "reference"] = "optional"
    """``always``, ``effort`` (one of these is enough), ``optional`` or ``reference`` (optional, and used by
    no computation yet)."""
    words: tuple[str, ...] = ()
    """Words that tell it in a column's name."""
    reference_to: str = ""
    """Channel that follows this reference."""

    @property
    def per_joint(self) -> bool:
        """Tell whether there is one column per joint, and not one of all."""
        return self.name != TIME

    @property
    def unit(self) -> str:
        """Name the SI unit; of two, the robot tells which: the joint is revolute or prismatic.

        Examples
        --------
        >>> CHANNELS["position"].unit, CHANNELS["current"].unit
        ('rad or m', 'A')
        """
        return " or ".join(dict.fromkeys((self.quantity.revolute, self.quantity.prismatic)))


TIME: Final = "time"
CHANNELS: Final[dict[str, Channel]] = {
    channel.name: channel
    for channel in (
        Channel(
            TIME, TIME, TIMES, "instant of the sample", "always",
            ("time", "t", "timestamp", "stamp", "sec", "seconds", "ms", "clock", "tick"),
        ),
        Channel(
            "position", "q", POSITIONS, "measured position of the joint", "always",
            ("q", "pos", "position", "positions", "angle", "angles", "theta", "joint", "joints", "ang",
             "state"),
        ),
        Channel(
            "velocity", "qd", VELOCITIES, "velocity of the joint, as the recorder gives it", "optional",
            ("qd", "dq", "vel", "velocity", "velocities", "speed", "speeds", "omega",
             "qdot"),
        ),
        Channel(
            "torque", "tau", TORQUES, "torque (prismatic: force) of the motor at the joint", "effort",
            ("tau", "torque", "torques", "trq", "trqs", "effort", "efforts", "eff", "moment", "moments",
             "mom", "tq", "force", "forces"),
        ),
        Channel(
            "current", "current", CURRENTS, "current of the motor", "effort",
            ("current", "currents", "cur", "curr", "amp", "amps", "i", "iq"),
        ),
        Channel(
            "temperature", "temperature", TEMPERATURES, "temperature of the joint", "optional",
            ("temperature", "temperatures", "temp", "temps"),
        ),
        Channel(
            "position_ref", "position_ref", POSITIONS, "position asked for by the controller", "reference",
            reference_to="position",
        ),
        Channel(
            "velocity_ref", "velocity_ref", VELOCITIES, "velocity asked for by the controller", "reference",
            reference_to="velocity",
        ),
        Channel(
            "torque_ref", "torque_ref", TORQUES, "torque asked for by the controller", "reference",
            reference_to="torque",
        ),
        Channel(
            "command", "command", COMMANDS, "controller's output, on the scale of its drive", "reference",
            ("command", "commands", "cmd"),
        ),
    )
}  # fmt: skip  # a table
"""All channels by name, in the order in which they are listed."""
JOINT_CHANNELS: Final = tuple(channel for channel in CHANNELS.values() if channel.per_joint)
EFFORTS: Final = tuple(channel.name for channel in JOINT_CHANNELS if channel.need == "effort")
UNITS: Final = {
    channel.name: {unit.name: unit for unit in channel.quantity.units} for channel in CHANNELS.values()
}
"""Units by channel and name, the SI unit of default names first."""

REFERENCE_WORDS: Final = frozenset(
    (
        "ref",
        "reference",
        "des",
        "desired",
        "cmd",
        "command",
        "commanded",
        "target",
        "setpoint",
        "setpoints",
        "targets",
        "goal",
        "planned",
    )
)
"""Words by which a column's name tells that it was asked for and not measured."""
