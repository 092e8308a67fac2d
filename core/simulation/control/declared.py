"""Hold what a user declares of a log's controller; what is left out is fitted to the log."""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from itertools import chain

import numpy as np

from ...arrays import JointVector, Mask, Vector
from ...errors import OptionError
from .controller import KINDS, LONGEST_DELAY, RULES, ControllerModel

Known = tuple[float | None, float | None, float | None]
"""kp, kd and ki of one joint; None for those that are fitted."""
GAINS = ("kp", "kd", "ki")
LISTS = (*GAINS, "torque_gain", "saturation")
"""What has one number per joint."""


@dataclass(frozen=True)
class DeclaredController:
    """Declare any part of a controller, in the units of `ControllerModel`; empty lists, None: fitted."""

    kind: str | None = None
    kp: tuple[float, ...] = ()
    kd: tuple[float, ...] = ()
    ki: tuple[float, ...] = ()
    torque_gain: tuple[float, ...] = ()
    velocity: str | None = None
    cutoff_hz: float | None = None
    delay_samples: int | None = None
    saturation: tuple[float, ...] = ()
    feed_forward: bool | None = None

    def __post_init__(self) -> None:
        """Refuse what is part of no controller."""
        known = [
            self.kind in (None, *KINDS),
            self.velocity in (None, *RULES),
            abs(self.delay_samples or 0) <= LONGEST_DELAY,
            self.cutoff_hz is None or (self.velocity == "filtered" and self.cutoff_hz > 0.0),
            min((*self.torque_gain, *self.saturation), default=1.0) > 0.0,
        ]
        lists = [getattr(self, name) for name in LISTS if getattr(self, name)]
        if not all(known) or len(set(map(len, lists))) > 1 or min(chain(*lists), default=0.0) < 0.0:
            raise OptionError(
                "the description of the controller is not valid",
                evidence={"pointer": "/options/controller", **dict(self.given())},
                remedy=f"give a kind of {', '.join(KINDS)}, a velocity of {', '.join(RULES)}, in every list "
                "one number per joint (gains at least zero, the others above), cutoff_hz for filtered alone, "
                f"and up to {LONGEST_DELAY} samples of delay",
            )

    def given(self) -> Iterator[tuple[str, object]]:
        """Give what is declared, by name."""
        for one in fields(self):
            value = getattr(self, one.name)
            if value is not None and value != ():
                yield one.name, value

    def allows(self, structure: ControllerModel) -> bool:
        """Tell whether a structure is one of those that are declared."""
        named = ("kind", "velocity", "delay_samples", "feed_forward")
        return all(getattr(self, name) in (None, getattr(structure, name)) for name in named)

    @property
    def channels(self) -> tuple[str, ...]:
        """List the channels that it takes besides references and command."""
        taken = {"velocity": self.velocity == "measured", "torque_ref": bool(self.feed_forward)}
        return tuple(name for name, wanted in taken.items() if wanted)

    @property
    def integrals(self) -> tuple[bool, ...]:
        """Say whether the controller may integrate."""
        return (any(self.ki),) if self.ki else (False, True)

    def known(self, joint: int) -> Known:
        """Give the gains of a joint, counted from 0."""
        kp, kd, ki = (getattr(self, name)[joint] if getattr(self, name) else None for name in GAINS)
        return kp, kd, ki

    def check_joints(self, joints: int, rate_hz: float) -> None:
        """Refuse gains of another number of joints, and a low pass that passes all.

        Raises
        ------
        OptionError
            If a list has not one number per joint, or the cut-off is not below half the rate.
        """
        if (self.cutoff_hz or 0.0) >= 0.5 * rate_hz:
            raise OptionError(
                "the cut-off of the declared controller is not below half the log's rate",
                evidence={"pointer": "/options/controller/cutoff_hz", "rate_hz": rate_hz},
                remedy="give a lower cut-off, or velocity backward, which has none",
            )
        lengths = {name: len(getattr(self, name)) for name in LISTS if getattr(self, name)}
        if any(length != joints for length in lengths.values()):
            raise OptionError(
                "the declared controller is not that of the log's joints",
                evidence={"pointer": "/options/controller", "numbers": lengths, "joints": joints},
                remedy="give one number per joint in every list",
            )

    def check_log(self, largest: JointVector, gain: Vector, tolerance: float) -> None:
        """Refuse a limit that the log's commands exceed, and a gain that its torques contradict.

        Parameters
        ----------
        largest
            The largest command of every joint.
        gain
            Torque per unit of the command, per joint; empty where the log does not tell.
        tolerance
            Share by which both may differ.

        Raises
        ------
        OptionError
            With what the log shows.
        """
        limit, declared = np.array(self.saturation), np.array(self.torque_gain)
        if len(limit):
            _refuse("saturation", limit, largest, largest > (1.0 + tolerance) * limit)
        if len(declared) and len(gain):
            _refuse("torque_gain", declared, gain, np.abs(gain - declared) > tolerance * declared)


def _refuse(name: str, declared: Vector, found: Vector, wrong: Mask) -> None:
    if wrong.any():
        raise OptionError(
            f"the declared {name} of the controller contradicts the log",
            evidence={
                "pointer": f"/options/controller/{name}",
                "declared": declared.tolist(),
                "in_the_log": [float(f"{value:.4g}") for value in found],
                "joints": (np.flatnonzero(wrong) + 1).tolist(),
            },
            remedy=f"leave {name} out, and it is taken from the log; or check the units of the channels",
        )
