"""Describe robots in requests and responses.

`RobotDescription` documents what `core.robot.description` reads and judges; a test keeps the two naming the
same fields.
"""

from typing import Annotated, Literal

from pydantic import Field, JsonValue

from .common import Instant, Next, Open, Strict, about

Triple = Annotated[list[float], Field(min_length=3, max_length=3)]
Pair = Annotated[list[float], Field(min_length=2, max_length=2)]


class Limits(Strict):
    """Bounds of a joint; null where unknown."""

    position: Annotated[Pair | None, about("lower and upper, rad or m")] = None
    velocity: Annotated[float | None, Field(gt=0, description="rad/s or m/s")] = None
    torque: Annotated[float | None, Field(gt=0, description="N m or N")] = None


class JointDescription(Strict):
    """A joint and the link it moves.

    With `convention` modified-dh, alpha, d, r and theta_offset are needed (Khalil-Kleinfinger letters: d is
    Craig's a, r is Craig's d). With frames, rotation and translation are needed.
    """

    name: Annotated[str | None, Field(max_length=100)] = None
    link: Annotated[str | None, Field(max_length=100, description="name of the moving body")] = None
    type: Literal["revolute", "prismatic"]
    antecedent: Annotated[
        int | None,
        Field(ge=0, description="the joint that carries this one, 0 for the base; default: the joint before"),
    ] = None
    alpha: Annotated[float | None, about("rad, about x, from the antecedent's z axis to this one")] = None
    d: Annotated[float | None, about("m, along x, from the antecedent's z axis to this one")] = None
    r: Annotated[float | None, about("m, along z; the variable of a prismatic joint adds to it")] = None
    theta_offset: Annotated[
        float | None, about("rad, about z; the variable of a revolute joint adds to it")
    ] = None
    gamma: Annotated[float, about("rad, about the antecedent's z axis (branches of a tree)")] = 0.0
    b: Annotated[float, about("m, along the antecedent's z axis (branches of a tree)")] = 0.0
    rotation: Annotated[
        list[Triple] | None,
        Field(min_length=3, max_length=3, description="frames: from this frame into the antecedent's"),
    ] = None
    translation: Annotated[Triple | None, about("frames: origin in the antecedent's frame, m")] = None
    ratio: Annotated[float, about("frames: of a joint that mimics another")] = 1.0
    offset: Annotated[float, about("frames: of a joint that mimics another, rad or m")] = 0.0
    mimics: Annotated[str | None, about("frames: the joint whose coordinate moves this one too")] = None
    limits: Limits | None = None
    rotor_inertia: Annotated[bool, about("identify the rotor's inertia IA of this joint")] = True
    friction: list[Literal["viscous", "coulomb", "offset"]] = Field(
        default=["viscous", "coulomb", "offset"], max_length=3
    )
    torque_constant: Annotated[
        float | None, about("N m/A, motor side; turns a logged current into torque")
    ] = None
    gear_ratio: Annotated[float | None, about("motor turns per joint turn")] = None


class CouplingDescription(Strict):
    """A motor that rotates with a weighted sum of joints (Staubli TX40: motor 6 with q5 + q6)."""

    name: Annotated[str, Field(max_length=100)]
    number: Annotated[
        int | None, Field(ge=1, description="used in its parameters' names; default: its last joint")
    ] = None
    joints: Annotated[list[int], Field(min_length=2, description="counted from 1")]
    weights: Annotated[list[float], Field(min_length=2)]


class StandardParameters(Strict):
    """Ten inertial parameters of a link about the origin of its frame: kg m2, kg m, kg."""

    XX: float
    XY: float
    XZ: float
    YY: float
    YZ: float
    ZZ: float
    MX: float
    MY: float
    MZ: float
    M: float


class LinkPrior(Strict):
    """Prior of a link: either standard, or mass, center_of_mass and inertia_at_com."""

    standard: StandardParameters | None = None
    mass: Annotated[float | None, about("kg")] = None
    center_of_mass: Annotated[Triple | None, about("m, in the link's frame")] = None
    inertia_at_com: Annotated[
        list[float] | None, Field(min_length=6, max_length=6, description="XX XY XZ YY YZ ZZ, kg m2")
    ] = None


class FixedFrame(Strict):
    """A named frame fixed to a link, such as the flange."""

    name: Annotated[str, Field(max_length=100, examples=["tool0"])]
    link: Annotated[int, Field(ge=1, description="counted from 1")]
    rotation: Annotated[list[Triple], Field(min_length=3, max_length=3, description="into the link's frame")]
    translation: Annotated[Triple, about("origin in the link's frame, m")]


Shape = Annotated[list[float], Field(min_length=4, max_length=4)]


class RobotDescription(Strict):
    """A robot: joints, gravity in the base frame, couplings, and the prior of its bodies."""

    name: Annotated[str, Field(max_length=100)]
    convention: Literal["modified-dh", "frames"] = "modified-dh"
    joints: Annotated[list[JointDescription], Field(min_length=1, max_length=64)]
    gravity: Triple = Field(
        default=[0.0, 0.0, -9.81],
        description="acceleration of gravity in the base frame, m/s2; points down on a level base",
    )
    couplings: list[CouplingDescription] | None = None
    prior: Annotated[list[LinkPrior] | None, about("one entry per joint")] = None
    frames: Annotated[
        list[FixedFrame] | None, Field(max_length=200, description="named frames: flange, tool0")
    ] = None
    shapes: Annotated[
        list[Shape | None] | None,
        about("per joint x, y, z, radius (m) of a ball that holds the link, in its frame; null: not known"),
    ] = None


class RobotSummary(Open):
    """A robot in a list."""

    id: str
    name: str
    joints: int
    built_in: bool
    created_at: Instant | None


class Robot(RobotSummary):
    """A robot. Robots are immutable: the same description has the same id."""

    suspicions: Annotated[
        list[str], about("warnings about a valid description, such as degrees instead of radians")
    ]
    description: RobotDescription


class RobotList(Open):
    """Robots, built-in ones first, then the newest."""

    robots: list[RobotSummary]
    next: Next


class BaseParameters(Open):
    """The base parameters of a robot."""

    robot: str
    counts: dict[str, int]
    rank: Annotated[
        dict[str, float],
        about(
            "the share below which a column counts as dependent (`relative_tolerance`): what lies outside "
            "the columns before it, over the column and their nearest combination; and the least share of "
            "one that was kept (`least_share_kept`)"
        ),
    ]
    base_parameters: list[dict[str, JsonValue]]
