"""Write a load as controllers take it: UR, ABB, KUKA, Staubli. No text was tried on a controller.

Sources, read and compared with what is written here: Universal Robots, Script Manual,
`set_target_payload` (SW 10.6: inertia about the mass centre along the flange's axes, Ixx Iyy Izz Ixy Ixz
Iyz); ABB, RAPID, `loaddata` (cog in mm, principal axes at the mass centre as a quaternion q1 to q4,
moments in kg m2; a tool's load in the wrist frame); KUKA, KR IONTEC specification (mm, degrees; A about
Z, then B about Y, then C about X) and Beckhoff TF5120, `KRC_WriteLoadData` (principal axes relative to
the flange). For Staubli no text of the maker was found.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import Rotation, Vector3
from ..robot.frames import rpy_of_rotation


@dataclass(frozen=True, eq=False)
class Load:
    """Hold a load in a controller's frame: kg, m, and kg m2 about its mass centre along the frame's axes."""

    mass: float
    centre: Vector3
    inertia: Rotation

    @property
    def principal(self) -> tuple[Vector3, Rotation]:
        """Give principal moments, kg m2, and their axes as columns of a rotation."""
        if np.abs(self.inertia - np.diag(np.diag(self.inertia))).max() <= 1e-12 * np.abs(self.inertia).max():
            return np.diag(self.inertia).copy(), np.eye(3)
        moments, axes = np.linalg.eigh(self.inertia)
        if np.linalg.det(axes) < 0.0:
            axes[:, 0] = -axes[:, 0]
        return np.maximum(moments, 0.0), axes


def ur(load: Load, frame: str) -> str:
    """Write a load as URScript takes it."""
    inertia = load.inertia
    entries = [inertia[at] for at in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    return (
        f"# payload in the frame {frame}, which has to be the tool flange's\n"
        f"set_target_payload({_number(load.mass)}, [{_listed(load.centre)}], [{_listed(entries)}])"
    )


def abb(load: Load, frame: str) -> str:
    """Write RAPID: a load that is held with tool0, or the tload of a tool."""
    moments, axes = load.principal
    return (
        f"! load in the frame {frame}, which has to be tool0\n"
        f"PERS loaddata identified := [{_number(load.mass)}, [{_listed(1e3 * load.centre)}], "
        f"[{_listed(quaternion(axes))}], {_listed(moments)}];"
    )


def kuka(load: Load, frame: str) -> str:
    """Write KRL for $config.dat."""
    moments, axes = load.principal
    x, y, z = map(_number, 1e3 * load.centre)
    c, b, a = map(_number, np.degrees(rpy_of_rotation(axes)))
    jx, jy, jz = map(_number, moments)
    return (
        f"; load in the frame {frame}, which has to be the flange's; choose the number of the tool\n"
        f"LOAD_DATA[1]={{M {_number(load.mass)},CM {{X {x},Y {y},Z {z},A {a},B {b},C {c}}},"
        f"J {{X {jx},Y {jy},Z {jz}}}}}"
    )


def staubli(load: Load, frame: str) -> str:
    """Write VAL 3 assignments of plain numbers: no maker's text on an instruction for loads was found."""
    names = ("nMass", "nCogX", "nCogY", "nCogZ", "nIxx", "nIxy", "nIxz", "nIyy", "nIyz", "nIzz")
    values = [load.mass, *(1e3 * load.centre), *load.inertia[np.triu_indices(3)]]
    lines = [f"{name}={_number(value)}" for name, value in zip(names, values, strict=True)]
    head = f"// load in the frame {frame}, which has to be the flange's: kg, mm, kg m2 about the centre"
    return "\n".join([head, *lines])


CONTROLLERS: Mapping[str, Callable[[Load, str], str]] = {
    "ur": ur,
    "abb": abb,
    "kuka": kuka,
    "staubli": staubli,
}
"""Writers by controller."""


def quaternion(rotation: Rotation) -> np.ndarray:
    """Give q1 (the scalar, not negative) to q4 of a rotation.

    Notes
    -----
    The largest eigenvector of a symmetric matrix keeps all digits for half turns too. Source: Bar-Itzhack,
    J. Guidance 23(6), 2000.

    Examples
    --------
    >>> quaternion(np.diag([1.0, -1.0, -1.0])).round(12) + 0.0
    array([0., 1., 0., 0.])
    """
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rotation
    table = np.array(
        [
            [xx + yy + zz, zy - yz, xz - zx, yx - xy],
            [zy - yz, xx - yy - zz, xy + yx, xz + zx],
            [xz - zx, xy + yx, yy - xx - zz, yz + zy],
            [yx - xy, xz + zx, yz + zy, zz - xx - yy],
        ]
    )
    found = np.linalg.eigh(table)[1][:, -1]
    first = found[np.flatnonzero(np.abs(found) > 1e-12)[0]]
    return np.asarray(found * np.sign(first))


def _listed(values: object) -> str:
    return ", ".join(_number(value) for value in np.asarray(values, dtype=float))


def _number(value: float) -> str:
    """Write a number without an exponent, which not every controller reads, to nanometres and nanograms."""
    text = f"{float(value):.9f}".rstrip("0").rstrip(".")
    return "0" if text in {"-0", ""} else text
