"""Read what a robot description gives of its links besides their joints: prior bodies, frames and shapes."""

import numpy as np

from ..arrays import LinkParameters, LinkTable
from ..errors import RobotError
from ..fields import Fields
from .inertia import from_mass_properties
from .model import INERTIAL_SYMBOLS, INERTIAL_UNITS, Ball, NamedFrame
from .right_angles import meant_rotation

PRIOR_FIELDS = {
    "standard": "an object with XX XY XZ YY YZ ZZ (kg m2) MX MY MZ (kg m) M (kg) about the frame's origin",
    "mass": "a number in kg",
    "center_of_mass": "three numbers in m in the link's frame",
    "inertia_at_com": "six numbers XX XY XZ YY YZ ZZ in kg m2 about the mass centre, along the frame's axes",
}
FIXED_FRAME_FIELDS = {
    "name": "a text, such as tool0 or flange",
    "link": "the number of the joint whose link carries it, counted from 1",
    "rotation": "three rows of three numbers: a rotation matrix from this frame into the link's",
    "translation": "three numbers in m: this frame's origin in the link's frame",
}
MOST_FRAMES = 200
SHAPE_FIELD = {"shape": "four numbers x, y, z, radius in m"}
SYMBOL_FIELDS = {symbol: f"a number in {unit}" for symbol, unit in INERTIAL_UNITS.items()}


OTHER_LETTERS = (
    "do not leave it out: the columns of the table have other letters here. Its a is d, its d is r, and the "
    "offset of its theta is theta_offset; a standard (distal) table also moves alpha and a down by one row, "
    "as docs/mdh.md shows"
)


class RobotFields(Fields):
    """Read the fields of an object of a robot description."""

    error = RobotError
    elsewhere = dict.fromkeys(("a", "theta", "a_i", "theta_i"), OTHER_LETTERS)


def read_prior(top: Fields, links: int) -> LinkTable | None:
    """Read the prior's bodies; None where the description gives none."""
    if not top.has("prior"):
        return None
    bodies = top.items("prior", least=links, most=links)
    return np.array([_body(value, number) for number, value in enumerate(bodies, start=1)])


def read_frames(top: Fields, links: int) -> tuple[NamedFrame, ...]:
    """Read the named frames fixed to links."""
    found: list[NamedFrame] = []
    for position, value in enumerate(top.items("frames", most=MOST_FRAMES) if top.has("frames") else ()):
        entry = RobotFields(value, f"frame {position + 1}", f"/frames/{position}", FIXED_FRAME_FIELDS)
        name = entry.text("name")
        if name in {earlier.name for earlier in found}:
            entry.refuse("name", f"repeats {name}, which is taken")
        link = entry.integer("link", (1, links))
        found.append(NamedFrame(name, link, read_rotation(entry), entry.numbers("translation", 3)))
    return tuple(found)


def read_shapes(top: Fields, links: int) -> tuple[Ball | None, ...] | None:
    """Read the ball that holds each link; None where the description gives none."""
    if not top.has("shapes"):
        return None
    listed = top.items("shapes", least=links, most=links)
    return tuple(_ball(top, value, number) for number, value in enumerate(listed, start=1))


def _ball(top: Fields, value: object, number: int) -> Ball | None:
    if value is None:
        return None
    row = RobotFields({"shape": value}, f"the shape of joint {number}", f"/shapes/{number - 1}", SHAPE_FIELD)
    x, y, z, radius = map(float, row.numbers("shape", 4))
    if radius < 0.0:
        top.refuse("shapes", f"gives joint {number} a radius below zero")
    return Ball((x, y, z), radius)


def _body(value: object, number: int) -> LinkParameters:
    body = RobotFields(value, f"the prior of joint {number}", f"/prior/{number - 1}", PRIOR_FIELDS)
    if "standard" in body.value:
        if len(body.value) > 1:
            raise RobotError(
                f"{body.where} is given twice",
                evidence={"pointer": body.pointer, "fields": list(body.value)},
                remedy="give either standard, or mass, center_of_mass and inertia_at_com",
            )
        table = RobotFields(body.value["standard"], body.where, f"{body.pointer}/standard", SYMBOL_FIELDS)
        return np.array([table.number(symbol) for symbol in INERTIAL_SYMBOLS])
    xx, xy, xz, yy, yz, zz = body.numbers("inertia_at_com", 6)
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return from_mass_properties(body.number("mass"), body.numbers("center_of_mass", 3), inertia)


def read_rotation(row: Fields) -> np.ndarray:
    """Read a rotation matrix, and take the right angles that six written digits mean."""
    rotation = row.rows("rotation", 3, least=3, most=3)
    # Six written digits are enough; more than that is not a rotation.
    if np.abs(rotation @ rotation.T - np.eye(3)).max() > 1e-5 or np.linalg.det(rotation) < 0.0:
        row.refuse("rotation", "is not a rotation: its rows are not orthonormal and right-handed")
    return meant_rotation(rotation)
